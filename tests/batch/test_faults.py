"""Whatever happens to a run, it goes on where it was and gives the same numbers.

Every fault here really happens: processes are killed, a disk is full, a scheduler is
gone. Runs in processes of their own are watched by the ledger that they write.
"""

import contextlib
import os
import random
import resource
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

import brdffit
from brdffit.batch.ledger import LEDGER
from tests.batch.wall import CHUNK, fit, same, wall

ROOT = Path(__file__).parents[2]
CHUNKS = 40
PATIENCE = 60  # seconds after which a process is taken for stuck
SOON = 2.0  # seconds within which an interrupted run ends


@pytest.fixture(scope="module")
def stack(tmp_path_factory):
    return wall(tmp_path_factory.mktemp("stack") / "wall.zarr", CHUNKS)


@pytest.fixture(scope="module")
def undisturbed(stack, tmp_path_factory):
    out = tmp_path_factory.mktemp("run") / "out"
    assert fit(stack, out).done == CHUNKS * CHUNK
    return out


@pytest.fixture(scope="module")
def programs(tmp_path_factory):
    """A folder for compiled programs that all processes of these tests share."""
    return tmp_path_factory.mktemp("programs")


@pytest.fixture
def start(programs):
    """Start a program; it is killed at the end if it still runs."""
    with contextlib.ExitStack() as stack:

        def start(*words):
            process = subprocess.Popen(
                [sys.executable, *map(str, words)],
                cwd=ROOT,
                env=os.environ | {"BRDFFIT_CACHE": str(programs)},
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                text=True,
            )
            stack.callback(process.communicate)
            stack.callback(process.kill)
            return process

        yield start


def finished(out):
    """Number of whole lines in the ledger of a run."""
    path = out / LEDGER
    return path.read_bytes().count(b"\n") if path.exists() else 0


def wait_until(process, condition):
    """Look until something is so, as long as the process runs."""
    end = time.monotonic() + PATIENCE
    while not condition():
        assert process.poll() is None, process.communicate()
        assert time.monotonic() < end
        time.sleep(0.002)


def test_a_run_killed_at_five_random_moments_is_the_same_in_the_end(
    start, stack, undisturbed, tmp_path
):
    draw, out, before = random.Random(5), tmp_path / "out", 0
    for _ in range(5):
        process = start("-m", "tests.batch.wall", stack.path, out)
        more = before + draw.randint(1, 6)
        wait_until(process, lambda more=more: finished(out) >= more)
        time.sleep(draw.uniform(0, 0.03))
        process.kill()
        assert process.wait() == -signal.SIGKILL
        assert finished(out) < CHUNKS
        before = finished(out)
    tally = fit(stack, out, resume=True)
    assert tally.kept >= (before - 1) * CHUNK  # the last line may be cut off
    assert tally.kept + tally.done == CHUNKS * CHUNK
    assert tally.done > 0
    assert not list(out.rglob("*.partial"))
    same(out, undisturbed)


def test_a_second_run_is_refused_while_the_first_goes_on(
    start, stack, undisturbed, tmp_path
):
    out = tmp_path / "out"
    process = start("-m", "tests.batch.wall", stack.path, out)
    wait_until(process, lambda: finished(out) >= 1)
    process.send_signal(signal.SIGSTOP)  # in mid-run, however fast it is
    with pytest.raises(BlockingIOError, match="written by another run"):
        fit(stack, out, resume=True)
    process.send_signal(signal.SIGCONT)
    assert process.wait(PATIENCE) == 0, process.communicate()
    same(out, undisturbed)


def test_an_interrupted_batch_ends_soon_and_says_how_to_go_on(start, tables, tmp_path):
    out = tmp_path / "out"
    program = "import sys; from brdffit.cli import main; sys.exit(main())"
    models = "lambert,he,principled,ggx_multiscatter,oren_nayar_full"
    files = [tables / "chalk.csv", tables / "slate.csv"]
    words = ("batch", *files, "--models", models, "--starts", "1", "--out", out)
    process = start("-c", program, *words)
    wait_until(process, lambda: finished(out) >= 1)
    time.sleep(0.2)  # now others are being compiled, which takes seconds
    process.send_signal(signal.SIGINT)
    begin = time.monotonic()
    said, err = process.communicate(timeout=PATIENCE)
    assert time.monotonic() - begin < SOON
    assert process.returncode == 130
    assert said == ""
    assert err.startswith("brdffit: Interrupted. ")
    assert f"of 10 fits are finished and kept in `{out}`: go on with --resume" in err
    kept = finished(out)
    assert 1 <= kept < 10
    assert f" {kept} of 10" in err
    done = brdffit.batch(files, ["lambert"], out, starts=1, resume=True)
    assert done.tally.kept >= 1
    assert done.tally.failed == 0


@pytest.fixture
def small_disk(tmp_path):
    """A disk that is nearly full, and how to make room on it."""
    disk = tmp_path / "disk"
    disk.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", "size=400k", "tmpfs", str(disk)]
    with contextlib.ExitStack() as stack:
        try:
            subprocess.run(mount, check=True, capture_output=True)
        except (OSError, subprocess.CalledProcessError):
            before = resource.getrlimit(resource.RLIMIT_FSIZE)
            limit = 1500  # bytes, which the ledger soon has
            resource.setrlimit(resource.RLIMIT_FSIZE, (limit, before[1]))
            stack.callback(resource.setrlimit, resource.RLIMIT_FSIZE, before)
            yield disk, lambda: resource.setrlimit(resource.RLIMIT_FSIZE, before)
        else:
            stack.callback(subprocess.run, ["umount", str(disk)], check=True)
            more = ["mount", "-o", "remount,size=100m", str(disk)]
            yield disk, lambda: subprocess.run(more, check=True)


def test_a_full_disk_ends_a_run_in_a_sentence_and_nothing_is_lost(
    stack, undisturbed, small_disk
):
    disk, make_room = small_disk
    out = disk / "out"
    with pytest.raises(OSError, match=r"No space left|too large") as stop:
        fit(stack, out)
    assert "go on with --resume" in str(stop.value)
    kept = finished(out)
    assert 0 < kept < CHUNKS
    make_room()
    tally = fit(stack, out, resume=True)
    assert 0 < tally.kept <= kept * CHUNK
    assert tally.kept + tally.done == CHUNKS * CHUNK
    same(out, undisturbed)

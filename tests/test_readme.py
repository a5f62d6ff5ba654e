"""What the README shows is what runs."""

import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

import brdffit
from brdffit.cli import app

ROOT = Path(__file__).parents[1]
README = (ROOT / "README.md").read_text()


def blocks(language):
    """The code blocks of one language, in their order."""
    return re.findall(rf"```{language}\n(.*?)```", README, flags=re.DOTALL)


def run(program, folder):
    done = subprocess.run(
        [sys.executable, "-c", program],
        cwd=folder,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_the_script_has_ten_lines_and_does_the_main_job(tmp_path):
    script = blocks("python")[0]
    assert len([line for line in script.splitlines() if line.strip()]) == 10
    printed = run(script, tmp_path)
    assert "'alpha': 0.2" in printed
    assert "cannot be told apart" in printed
    ranking = [line.split()[0] for line in printed.splitlines()[-3:]]
    assert ranking == ["cook_torrance", "phong", "oren_nayar"]
    assert (tmp_path / "spheres.png").read_bytes().startswith(b"\x89PNG")


def test_the_example_of_a_model_works_at_once(tmp_path):
    *_, model, use = blocks("python")
    (tmp_path / "minnaert.py").write_text(model)
    printed = run(use, tmp_path)
    assert printed.startswith("minnaert {'albedo'")
    k = float(re.search(r"'k': ([\d.]+)", printed)[1])
    assert k == pytest.approx(1.4, abs=0.02)


def test_the_scene_calls_for_what_it_holds(tmp_path):
    (tmp_path / "scene.toml").write_text(blocks("toml")[0])
    printed = run(blocks("python")[1], tmp_path)
    assert printed == "['falloff', 'shadows']\n"


def test_the_wall_of_known_truth_is_found_again(tmp_path):
    (script,) = (block for block in blocks("python") if "wall" in block)
    run(script.replace("128, 24", "16, 24"), tmp_path)
    done = brdffit.svbrdf("ggx", tmp_path / "wall", tmp_path / "maps", hold_out="6")
    assert done.summary["held_out"]["photograph"] == "05.exr"
    assert done.summary["held_out"]["relative_rms"] < 0.02
    assert done.summary["parameters"]["alpha"]["median"] == pytest.approx([0.15], 0.02)


def test_commands_are_understood_as_they_stand():
    lines = [line for block in blocks("sh") for line in block.splitlines()]
    commands = [line for line in lines if line.startswith("brdffit ")]
    assert len(commands) >= 8
    for command in commands:
        words = shlex.split(command, comments=True)[1:]
        app.parse_args(words, exit_on_error=False, print_error=False)


def test_the_table_can_be_read(tmp_path):
    path = tmp_path / "table.csv"
    path.write_text(blocks("text")[0])
    data = brdffit.load(path)
    assert data.name == "black anodised aluminium"
    assert data.f_r[:, 0].tolist() == [0.0306, 0.0351]


def test_continuous_integration_runs_the_tests_as_the_readme_does():
    (command,) = (line for line in README.splitlines() if "pytest" in line)
    assert command in (ROOT / ".ci" / "run").read_text().splitlines()


def test_pictures_are_there_and_small():
    pictures = [ROOT / name for name in re.findall(r"!\[.*?\]\((.*?)\)", README)]
    assert pictures
    assert all(picture.stat().st_size < 300_000 for picture in pictures)

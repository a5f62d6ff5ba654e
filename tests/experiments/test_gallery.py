"""All experiments in one run, and the pages that are made of what they leave."""

import re
import tomllib
from pathlib import Path

import pytest

from brdffit.models import MODELS
from experiments import __main__ as every, gallery
from experiments.captions import CAPTIONS
from experiments.record import RESULTS, Record, digest

ROOT = RESULTS.parent
NOT_EXPERIMENTS = {"gallery", "hard_cases_truth"}  # scripts all the same


def scripts():
    folder = Path(gallery.__file__).parent
    return {
        path.stem
        for path in folder.glob("*.py")
        if 'if __name__ == "__main__"' in path.read_text() and path.stem != "__main__"
    }


def test_every_experiment_is_in_the_list():
    assert set(gallery.questions()) == scripts() - NOT_EXPERIMENTS


def test_experiments_on_time_have_the_machine_to_themselves(monkeypatch, capsys):
    asked = {}

    def run(name, cores):
        asked[name] = list(cores)
        return 2.0, "it broke" if name == "ptfe" else ""

    monkeypatch.setattr(every, "run", run)
    monkeypatch.setattr(gallery, "main", lambda: asked.update(gallery=[]))
    monkeypatch.setattr(every.os, "sched_getaffinity", lambda _: {3, 5})
    assert every.main(["ptfe", "solvers", "curet_matte"]) == 1
    assert list(asked)[0] == "solvers"
    assert asked["solvers"] == [3, 5]
    assert len(asked["ptfe"]) == len(asked["curet_matte"]) == 1
    assert list(asked)[-1] == "gallery"
    printed = capsys.readouterr().out
    assert "ptfe 2 s, failed:\nit broke" in printed
    assert "[3/3]" in printed
    assert "failed: ptfe" in printed
    assert every.main(["solvers"]) == 0


def test_what_is_timed_is_the_first_part_of_the_list():
    assert {"forward_models", "solvers", "bounce_depth"} <= set(gallery.timed())
    assert "ptfe" not in gallery.timed()
    for name in gallery.timed():
        source = Path(gallery.__file__).with_name(f"{name}.py").read_text()
        assert "    use_one_core()" in source


def test_an_experiment_runs_in_a_process_of_its_own():
    seconds, why = every.run("no_such_experiment", [0])
    assert seconds > 0
    assert "no_such_experiment" in why


def test_an_unknown_experiment_is_refused():
    with pytest.raises(ValueError, match="Did you mean `solvers`"):
        every.main(["solver"])


def test_the_gallery_shows_what_an_experiment_left(tmp_path):
    record = Record(tmp_path / "solvers")
    record.table([{"a": 1.0}])
    record.close(finding="It is 3 times faster.")
    (tmp_path / "solvers" / "figure.png").write_bytes(b"png")
    (tmp_path / "solvers" / "figure.pdf").write_bytes(b"pdf")
    text = "\n".join(gallery.section("solvers", "which?", tmp_path))
    assert "**It is 3 times faster.**" in text
    assert "![which?](solvers/figure.png)" in text
    assert "[table.csv](solvers/table.csv)" in text
    assert "not been run" in "\n".join(gallery.section("ptfe", "q?", tmp_path))


def test_pages_are_what_the_results_make():
    assert gallery.PAGE.read_text(encoding="utf-8") == gallery.page()
    readme = gallery.README.read_text(encoding="utf-8")
    assert readme == gallery.filled(readme)


def test_pictures_of_the_readme_are_those_that_experiments_wrote():
    text = gallery.README.read_text(encoding="utf-8")
    shown = re.findall(r'!\[[^\]]*\]\(([^)]+)\)|<img src="([^"]+)"', text)
    paths = [ROOT / (markdown or html) for markdown, html in shown]
    assert len(paths) >= len(MODELS) - 1  # a sphere of each; a sum is none
    for path in paths:
        run = tomllib.loads((path.parent / "run.toml").read_text())
        assert run["sha256"][path.name] == digest(path), path


def test_captions_are_worked_out_from_tables(tmp_path):
    folder = tmp_path / "ptfe"
    record = Record(folder)
    rows = [("ggx", 1.52), ("lambert", 7.66)]
    record.table([{"model": m, "relative_rms_percent": x} for m, x in rows])
    record.close()
    text = "\n".join(gallery.section("ptfe", "which?", tmp_path))
    assert "**ggx leaves 1.5 % where lambert leaves 7.7 %.**" in text
    assert set(CAPTIONS) <= set(gallery.questions())

import json

import brdffit
from brdffit.batch import Tally
from brdffit.cli import console


def test_a_batch_is_told_and_goes_on_when_asked(run, chalk, tmp_path):
    out = tmp_path / "out"
    words = ("batch", chalk, "--models", "lambert", "--starts", "1", "--out", out)
    status, said, err = run(*words)
    assert (status, err) == (0, "")
    assert "1 of 1 fits finished; 1 done now" in said
    assert "results.csv" in said

    status, said, err = run(*words)
    assert status == 2
    assert "holds an earlier run: go on with it by --resume" in err
    assert said == ""

    status, said, err = run(*words, "--resume", "--json")
    assert (status, err) == (0, "")
    outcome = json.loads(said)
    assert [row["model"] for row in outcome["rows"]] == ["lambert"]
    assert str(out / "index.html") in outcome["files"]


def test_a_failure_is_told_once_for_all_models_and_is_no_success(run, tmp_path):
    words = ("--models", "lambert,phong", "--out", tmp_path / "out")
    status, said, err = run("batch", tmp_path / "absent.csv", *words)
    assert (status, err) == (1, "")
    assert said.count("absent.csv, lambert, phong: File") == 1
    assert "2 failed" in said


def test_bad_input_is_one_sentence(run, chalk, tmp_path):
    out = ("--out", tmp_path / "out")
    status, _, err = run("batch", chalk, "--models", "lamberd", *out)
    assert (status, err.count("\n")) == (2, 1)
    assert "Did you mean `lambert`" in err
    status, _, err = run(
        "batch", chalk, "--models", "lambert", "--cluster", "nowhere", *out
    )
    assert (status, err.count("\n")) == (2, 1)
    assert "no Dask scheduler at `nowhere`" in err


def test_all_is_the_whole_catalogue():
    from brdffit.cli.options import chosen_models

    assert chosen_models("all") == list(brdffit.MODELS)
    assert chosen_models("ggx, lambert") == ["ggx", "lambert"]


def test_progress_tells_rate_time_left_and_failures(capsys, monkeypatch):
    tally = Tally("texels", 1000, kept=600, done=100, not_converged=3, seconds=2.0)
    assert console.pace(tally) == "50/s, 0:00:06 left, 3 not converged"
    with console.tally_bar() as show:
        show(tally)
    assert capsys.readouterr() == ("", "")
    monkeypatch.setattr("sys.stderr.isatty", lambda: True)
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setenv("COLUMNS", "120")
    with console.tally_bar() as show:
        show(tally)
    _, err = capsys.readouterr()
    for words in ("700 of 1,000 texels", "70%", "50/s", "3 not converged"):
        assert words in err

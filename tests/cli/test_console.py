import json

import pytest

from brdffit.cli import console, main


def test_progress_is_silent_where_there_is_no_terminal(capsys):
    with console.progress(2) as step:
        step("one")
        step("two")
    assert capsys.readouterr() == ("", "")


def test_progress_names_its_step_on_a_terminal(capsys, monkeypatch):
    monkeypatch.setattr("sys.stderr.isatty", lambda: True)
    monkeypatch.setenv("TERM", "xterm")
    with console.progress(2) as step:
        step("fitting [ggx]")
    out, err = capsys.readouterr()
    assert out == ""
    assert "fitting [ggx]" in err


def test_json_has_no_numbers_that_json_does_not_know():
    with pytest.raises(ValueError, match="JSON"):
        console.print_json({"error": float("nan")})


def test_json_is_one_object(capsys):
    console.print_json({"a": [1, 2.5], "b": None})
    assert json.loads(capsys.readouterr().out) == {"a": [1, 2.5], "b": None}


def test_interruption_is_told_and_has_its_own_status(monkeypatch, capsys):
    def interrupted(*_words):
        raise KeyboardInterrupt

    monkeypatch.setattr("brdffit.cli._run", interrupted)
    assert main(["models"]) == 130
    assert capsys.readouterr().err == "brdffit: Interrupted.\n"

"""Nothing counts as finished that is not, and one run has a folder at a time."""

import json

import pytest

from brdffit.batch import ledger
from brdffit.batch.ledger import LEDGER, Record, fingerprint, open_ledger, seal


def written(folder, name="chunk", content=b"numbers"):
    path = folder / name
    path.write_bytes(content)
    return path


def test_what_was_committed_is_there_for_the_next_run(tmp_path):
    file = written(tmp_path.parent, tmp_path.name + ".chunk")
    record = Record("3", fingerprint(model="ggx"), seal([file]), {"not_converged": 2})
    with open_ledger(tmp_path / "run", resume=False) as book:
        book.commit(record)
    with open_ledger(tmp_path / "run", resume=True) as book:
        assert book.records == {"3": record}
        assert book.records["3"].holds(fingerprint(model="ggx"), [file])


def test_a_line_that_was_cut_off_is_none_and_the_next_is_whole(tmp_path):
    first, second, third = (Record(key, "f", "c") for key in "123")
    with open_ledger(tmp_path, resume=False) as book:
        book.commit(first)
        book.commit(second)
    path = tmp_path / LEDGER
    path.write_bytes(path.read_bytes()[:-9])
    with open_ledger(tmp_path, resume=True) as book:
        assert list(book.records) == ["1"]
        book.commit(third)
    lines = [json.loads(line)["key"] for line in path.read_text().splitlines()]
    assert lines == ["1", "3"]


@pytest.mark.parametrize("spoil", ["content", "fingerprint", "absence"])
def test_a_record_does_not_hold_for_anything_else(tmp_path, spoil):
    file = written(tmp_path)
    record = Record("1", fingerprint(model="ggx"), seal([file]))
    assert record.holds(fingerprint(model="ggx"), [file])
    mark = fingerprint(model="phong" if spoil == "fingerprint" else "ggx")
    if spoil == "content":
        file.write_bytes(b"numberz")
    if spoil == "absence":
        file.unlink()
    assert not record.holds(mark, [file])


def test_another_version_is_another_fingerprint(monkeypatch):
    before = fingerprint(model="ggx")
    monkeypatch.setattr(ledger, "version", lambda _: "99.0")
    assert fingerprint(model="ggx") != before


def test_a_second_run_is_refused_while_the_first_goes_on(tmp_path):
    with (
        open_ledger(tmp_path, resume=False),
        pytest.raises(BlockingIOError, match="written by another run"),
        open_ledger(tmp_path, resume=True),
    ):
        pass
    with open_ledger(tmp_path, resume=True):  # and may come after it
        pass


@pytest.mark.parametrize("resume", [False, True])
def test_a_folder_of_other_files_is_left_alone(tmp_path, resume):
    written(tmp_path, "thesis.tex")
    with (
        pytest.raises(FileExistsError, match="holds other files"),
        open_ledger(tmp_path, resume),
    ):
        pass
    assert [path.name for path in tmp_path.iterdir()] == ["thesis.tex"]


def test_an_earlier_run_is_gone_on_with_only_when_asked(tmp_path):
    with open_ledger(tmp_path, resume=False) as book:
        book.commit(Record("1", "f", "c"))
    with (
        pytest.raises(FileExistsError, match="--resume"),
        open_ledger(tmp_path, resume=False),
    ):
        pass
    with open_ledger(tmp_path, resume=True) as book:
        assert "1" in book.records

import pytest

from brdffit.files import replacing, require_writable


def test_a_file_appears_whole_or_not_at_all(tmp_path):
    path = tmp_path / "result.json"
    path.write_text("old")
    with pytest.raises(ZeroDivisionError), replacing(path) as temporary:
        temporary.write_text(str(1 / 0))
    assert path.read_text() == "old"
    with replacing(path) as temporary:
        assert temporary.suffix == ".json"
        temporary.write_text("new")
        assert path.read_text() == "old"
    assert path.read_text() == "new"
    assert list(tmp_path.iterdir()) == [path]


def test_a_file_in_no_folder_is_refused(tmp_path):
    with (
        pytest.raises(OSError, match="cannot be written"),
        replacing(tmp_path / "missing" / "x.txt"),
    ):
        pass


def test_folders_that_can_be_written_are_left_as_they_are(tmp_path):
    require_writable(tmp_path)
    require_writable(tmp_path / "new" / "folder")
    assert list(tmp_path.iterdir()) == []


def test_folders_that_cannot_be_written_are_named(tmp_path, monkeypatch):
    taken = tmp_path / "taken"
    taken.touch()
    for folder in (taken, taken / "below"):
        with pytest.raises(OSError, match="taken` is not a folder"):
            require_writable(folder)

    def refuse(dir):
        raise PermissionError(13, "Permission denied", str(dir))

    monkeypatch.setattr("tempfile.TemporaryFile", refuse)
    with pytest.raises(OSError, match=r"takes no new files \(Permission denied\)"):
        require_writable(tmp_path / "out")

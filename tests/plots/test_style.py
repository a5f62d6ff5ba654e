import matplotlib as mpl
import pytest
from matplotlib.figure import Figure

from brdffit.plots.style import entitle, lines, new_figure, save, spread, styled


def test_six_models_have_six_looks():
    looks = lines(6)
    assert len({look["color"] for look in looks}) == 6
    assert len({str(look["linestyle"]) for look in looks}) == 6


def test_spread_keeps_the_ends():
    assert spread(range(12), 4) == [0, 4, 7, 11]
    assert spread([1, 2], 4) == [1, 2]


def test_a_figure_is_saved_as_png_and_pdf(tmp_path):
    figure = new_figure(2.0, 2.0)
    figure.subplots()
    written = save(figure, tmp_path, "empty")
    assert [path.name for path in written] == ["empty.png", "empty.pdf"]
    assert written[0].read_bytes().startswith(b"\x89PNG")
    assert written[1].read_bytes().startswith(b"%PDF")
    assert sorted(tmp_path.iterdir()) == sorted(written)


class Unfinished(Figure):
    """A figure whose file breaks off."""

    def savefig(self, path, **_):
        path.write_bytes(b"half")
        raise RuntimeError("no more ink")


def test_a_figure_that_breaks_off_leaves_nothing(tmp_path):
    with pytest.raises(RuntimeError, match="no more ink"):
        save(Unfinished(), tmp_path, "broken")
    assert list(tmp_path.iterdir()) == []


def test_the_look_does_not_leak():
    before = mpl.rcParams["axes.grid"]

    @styled
    def inside():
        return mpl.rcParams["axes.grid"]

    assert inside()
    assert mpl.rcParams["axes.grid"] == before


def test_a_long_title_takes_several_lines_and_no_formula():
    figure = new_figure(3.0, 2.0)
    entitle(figure, "a name with $ and $, " * 4)
    lines_of_title = figure.get_suptitle().splitlines()
    assert len(lines_of_title) > 1
    assert max(len(line) for line in lines_of_title) < 40
    assert r"\$" in lines_of_title[0]

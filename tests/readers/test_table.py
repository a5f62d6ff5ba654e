import numpy as np
import pytest

from brdffit.readers import table
from tests.readers import specimens

HEADER = "# brdffit table 1\n# angles: degrees\n# cosine: not included\n"
COLUMNS = "theta_i,phi_i,theta_o,phi_o,f_r\n"


def read(tmp_path, text):
    path = tmp_path / "a.csv"
    path.write_text(text)
    return table.load(path)


def test_angles_in_degrees_become_directions(tmp_path):
    measured = read(tmp_path, HEADER + COLUMNS + "30,0,60,180,0.5\n-30,0,60,90,2\n")
    root = np.sqrt(3) / 2
    np.testing.assert_allclose(measured.wi, [[0.5, 0, root], [-0.5, 0, root]])
    np.testing.assert_allclose(
        measured.wo, [[-root, 0, 0.5], [0, root, 0.5]], atol=1e-15
    )
    np.testing.assert_array_equal(measured.f_r, [[0.5], [2]])
    assert measured.channels == ("f_r",)
    assert measured.name == "a"


def test_the_page_that_users_read_is_itself_a_table(tmp_path):
    page = table.__doc__.partition("like this::")[2].partition("\n\nThe first line")[0]
    text = "\n".join(line.strip() for line in page.strip().splitlines())
    measured = read(tmp_path, text + "\n")
    assert measured.name == "black anodised aluminium"
    np.testing.assert_array_equal(measured.f_r, [[0.0306], [0.0351]])
    mirror = measured.wi[1] * [-1, -1, 1]
    np.testing.assert_allclose(measured.wo[1], mirror, atol=1e-15)


def test_radians_and_an_included_cosine_are_undone(tmp_path):
    text = (HEADER + COLUMNS + "1,0,0.5,3,0.5\n").replace("degrees", "radians")
    measured = read(tmp_path, text.replace("not included", "included"))
    np.testing.assert_allclose(measured.wi[0, 2], np.cos(1))
    np.testing.assert_allclose(measured.f_r, [[0.5 / np.cos(1)]])


def test_columns_come_in_any_order_with_sigma_mask_and_solid_angle(tmp_path):
    names = "mask_b,b,a,sigma_b,sigma_a,mask_a,solid_angle,theta_i,phi_i,theta_o,phi_o"
    header = HEADER + "# channels: a, b\n# name: order\n# note: any comment\n"
    measured = read(tmp_path, f"{header}{names}\n0,2,1,0.2,0.1,1,0.5,10,0,20,30\n")
    assert measured.channels == ("a", "b")
    assert measured.name == "order"
    np.testing.assert_array_equal(measured.f_r, [[1, 2]])
    np.testing.assert_array_equal(measured.sigma, [[0.1, 0.2]])
    np.testing.assert_array_equal(measured.mask, [[True, False]])
    np.testing.assert_array_equal(measured.solid_angle, [0.5])


def test_files_from_other_systems_are_read(tmp_path):
    path = tmp_path / "a.csv"
    text = HEADER + "# name: caf\u00e9\n" + COLUMNS + "10,0,20,30,1\n\n"
    path.write_bytes(b"\xef\xbb\xbf" + text.replace("\n", "\r\n").encode())
    assert table.load(path).name == "caf\u00e9"


def test_what_is_no_reflectance_is_kept_and_masked(tmp_path):
    rows = "10,0,20,0,1\n10,0,20,0,nan\n10,0,20,0,inf\n10,0,20,0,-1\n90,0,20,0,1\n"
    measured = read(tmp_path, HEADER + COLUMNS + rows + "10,0,91,0,1\n10,0,20,0,0\n")
    expected = [True, False, False, False, False, False, True]
    np.testing.assert_array_equal(measured.mask[:, 0], expected)
    assert np.isnan(measured.f_r[1, 0])


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("# brdffit table 1\n", "ends before the line with the names"),
        (HEADER, "ends before the line with the names"),
        (HEADER + COLUMNS, "holds no rows"),
        (HEADER.replace("# cos", "# kos") + COLUMNS + "1,0,2,3,1\n", "# cosine: not"),
        (
            HEADER.replace("not ", "maybe "),
            "Line 3 .* must be not included or included",
        ),
        (HEADER.replace("degrees", "grad"), "Line 2 .* must be degrees or radians"),
        (
            HEADER.replace("# angles: degrees\n", "") + COLUMNS + "1,0,2,3,1\n",
            "unit of",
        ),
        (HEADER + COLUMNS + "1,0,2,3,1\n1,0,2,3\n", "Line 6 .* 5 numbers, .* has 4"),
        (HEADER + COLUMNS + "1,0,2,3,1,7\n", "Line 5 .* 5 numbers, but this has 6"),
        (HEADER + COLUMNS + "1,0,2,3,\n", "Line 5 .*`` is not a number"),
        (HEADER + COLUMNS + "1,0,2,3,1,5\n1;0\n", "Line 5"),
        (HEADER + COLUMNS + "1,0,2,nan,1\n", "must be finite"),
        (HEADER + COLUMNS + "1,0,2,3,nan\n", "holds no value that can be used"),
        (HEADER + "# rows: 3\n" + COLUMNS + "1,0,2,3,1\n", "has 1 rows, but .* says 3"),
        (HEADER + "theta_i,phi_i,theta_o,f_r\n1,2,3,4\n", "must include theta_i"),
        (HEADER + "theta_i,phi_i,theta_o,phi_o\n1,2,3,4\n", "at least one column"),
        (HEADER + COLUMNS.replace("f_r", "f,f") + "1,2,3,4,5,6\n", "stands twice"),
        (HEADER + "# channels: R\n" + COLUMNS + "1,2,3,4,5\n", "promises channel `R`"),
        (
            HEADER + "# channels: f_r\n" + COLUMNS[:-1] + ",x\n1,2,3,4,5,6\n",
            "column `x` is not known",
        ),
        (
            HEADER + COLUMNS[:-1] + ",g,sigma_g\n1,2,3,4,5,6,7\n",
            "`sigma_` must stand before every channel or none",
        ),
    ],
)
def test_a_wrong_table_is_one_sentence(tmp_path, text, sentence):
    with pytest.raises(ValueError, match=sentence):
        read(tmp_path, text)


def test_vectors_must_have_unit_length(tmp_path):
    path = specimens.table(tmp_path)
    lines = path.read_text().splitlines()
    lines[-1] = "0,0,2,0,0,1,1,1,1"
    path.write_text("\n".join(lines) + "\n")
    with pytest.raises(ValueError, match="must be unit vectors.* off by 1"):
        table.load(path)

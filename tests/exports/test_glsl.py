import ctypes
import shutil
import subprocess

import numpy as np
import pytest

from brdffit import MODELS
from brdffit.catalogue import from_name
from brdffit.exports import glsl
from brdffit.exports.deviation import deviation, pairs
from brdffit.exports.material import evaluator

NAMES = sorted(set(MODELS) - {"he"})  # erfc is not in GLSL
TOLERANCE = 2e-5
SHIM = """
#include <cmath>
#include <algorithm>
using namespace std;
struct vec3 { float x, y, z; vec3(float a, float b, float c) : x(a), y(b), z(c) {} };
static float sign(float x) { return x > 0 ? 1.f : x < 0 ? -1.f : 0.f; }
"""
MAIN = """
in vec3 light, viewer;
out vec4 colour;
void main() { colour = vec4(brdf(light, viewer), 1.0); }
"""
LOOP = """
extern "C" void many_NAME(int count, const float* i, const float* o, float* f)
{
    for (int n = 0; n < count; n++, i += 3, o += 3, f += 3) {
        vec3 v = NAME::brdf(vec3(i[0], i[1], i[2]), vec3(o[0], o[1], o[2]));
        f[0] = v.x; f[1] = v.y; f[2] = v.z;
    }
}
"""


@pytest.fixture(scope="module")
def programs():
    return {name: glsl.translate(from_name(name)).evaluate for name in NAMES}


@pytest.mark.parametrize("name", NAMES)
def test_statements_are_the_model(programs, name):
    error = deviation(evaluator(from_name(name)), programs[name])
    assert error.largest < TOLERANCE


def test_nothing_is_reflected_at_and_below_the_horizon(programs):
    wi = np.array([[0.0, 0.6, -0.8], [1.0, 0.0, 0.0], [0.0, 0.6, 0.8]])
    wo = np.array([[0.6, 0.0, 0.8], [0.0, 0.6, 0.8], [0.0, 0.6, 0.8]])
    f_r = programs["ggx"](wi, wo)
    assert (f_r[:2] == 0).all()
    assert (f_r[2] > 0).all()


def test_one_channel_is_grey(programs):
    wi, wo = pairs(20)
    grey = glsl.translate(from_name("phong", channels=1)).evaluate(wi, wo)
    assert np.array_equal(grey, programs["phong"](wi, wo))


def test_what_glsl_cannot_do_is_refused():
    with pytest.raises(ValueError, match="needs the operation `erfc`"):
        glsl.translate(MODELS["he"]())
    with pytest.raises(ValueError, match="must be grey or R, G, B"):
        glsl.translate(from_name("ggx", channels=4))
    with pytest.raises(ValueError, match="has the channels 450 nm, 550 nm, 650 nm"):
        glsl.translate(from_name("ggx"), ("450 nm", "550 nm", "650 nm"))


def in_namespace(name, program):
    """The GLSL text as C++, of which it uses the common part."""
    text = glsl.source(program, {"model": name})
    return f"namespace {name} {{\n{text}\n}}\n" + LOOP.replace("NAME", name)


@pytest.fixture(scope="module")
def library(programs, tmp_path_factory):
    compiler = shutil.which("c++") or shutil.which("g++") or shutil.which("clang++")
    if compiler is None:
        pytest.skip("a C++ compiler is needed to carry the text out")
    folder = tmp_path_factory.mktemp("glsl")
    text = SHIM + "".join(in_namespace(name, programs[name]) for name in NAMES)
    (folder / "all.cpp").write_text(text)
    command = [compiler, "-O0", "-shared", "-fPIC", "-fsingle-precision-constant"]
    subprocess.run(
        [*command, "-w", "-o", folder / "all.so", folder / "all.cpp"], check=True
    )
    return ctypes.CDLL(str(folder / "all.so"))


@pytest.mark.parametrize("name", NAMES)
def test_text_is_valid_in_a_shader(programs, name, tmp_path):
    """By the reference of Khronos, which Debian's package glslang-tools holds."""
    if shutil.which("glslangValidator") is None:
        pytest.skip("glslangValidator is needed to judge the text as GLSL")
    text = glsl.source(programs[name], {"model": name})
    shader = tmp_path / f"{name}.frag"
    shader.write_text(f"#version 130\n{text}\n{MAIN}")
    done = subprocess.run(
        ["glslangValidator", str(shader)], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout


@pytest.mark.parametrize("name", NAMES)
def test_text_compiles_and_computes_the_model(library, name):
    def carried_out(wi, wo):
        arrays = [np.ascontiguousarray(w, np.float32) for w in (wi, wo)]
        found = np.empty_like(arrays[0])
        places = [a.ctypes.data_as(ctypes.c_void_p) for a in (*arrays, found)]
        getattr(library, f"many_{name}")(len(wi), *places)
        return found

    error = deviation(evaluator(from_name(name)), carried_out)
    assert error.largest < TOLERANCE

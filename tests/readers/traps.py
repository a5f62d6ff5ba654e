"""Files and folders that lie: bombs, devices, links, paths out of their folder."""

import io
import os
import struct
import zlib

import numpy as np
import scipy.io

from brdffit import images
from tests.readers.specimens import (
    SPECIMENS,
    curet,
    exr_stack,
    fred,
    merl,
    rgl,
    sphere_exr,
    sphere_photos,
    utia,
)

OUTSIDE = (
    "/dev/zero",
    "/dev/stdin",
    "/etc/passwd",
    "../../../../etc/passwd",
    "..",
    ".",
    "",
    "a\\u0000b",
    "x" * 5000,
)


def png(rows, columns, body=b"", depth=16):
    """A PNG that claims a size: RGB of 16 bits or grey of 8, with whatever body."""

    def chunk(kind, content):
        check = zlib.crc32(kind + content)
        return (
            struct.pack(">I", len(content)) + kind + content + struct.pack(">I", check)
        )

    colours = 2 if depth == 16 else 0
    head = struct.pack(">IIBBBBB", columns, rows, depth, colours, 0, 0, 0)
    parts = (b"IHDR", head), (b"IDAT", body), (b"IEND", b"")
    return b"\x89PNG\r\n\x1a\n" + b"".join(chunk(*part) for part in parts)


def black(rows, columns, depth=16):
    """A PNG of nothing but zeros, a thousandth as large as its pixels."""
    packer = zlib.compressobj()
    row = bytes(1 + columns * (6 if depth == 16 else 1))
    parts = [packer.compress(row) for _ in range(rows)]
    return png(rows, columns, b"".join([*parts, packer.flush()]), depth)


def disc(size):
    """A mask of eight bits of a disc that fills a square."""
    centre = (2 * np.arange(size) + 1) / size - 1
    inside = 255 * (np.hypot(centre[:, None], centre) < 1).astype(np.uint8)
    rows = np.pad(inside, ((0, 0), (1, 0))).tobytes()
    return png(size, size, zlib.compress(rows), 8)


def a_photograph_that_claims_to_be_huge(folder):
    path = sphere_photos(folder)
    (path / "000.png").write_bytes(png(2**31 - 1, 2**31 - 1))
    return path


def a_photograph_that_unpacks_to_a_thousandfold(folder):
    path = sphere_photos(folder)
    (path / "000.png").write_bytes(black(8000, 8000))
    return path


def a_mask_that_unpacks_to_a_thousandfold(folder):
    path = sphere_photos(folder)
    (path / "mask.png").write_bytes(black(20_000, 20_000, depth=8))
    return path


def black_photographs_of_a_large_ball(folder):
    path = sphere_photos(folder)
    (path / "mask.png").write_bytes(disc(1000))
    for name in ("000", "001", "002"):
        (path / f"{name}.png").write_bytes(black(1000, 1000))
    return path


def a_photograph_as_large_as_is_let_through(folder):
    path = sphere_photos(folder)
    (path / "000.png").write_bytes(black(2000, 2000))
    return path


def a_tiff_that_claims_to_be_huge(folder):
    path = sphere_photos(folder)
    (path / "000.png").unlink()
    images.write(path / "000.tif", np.zeros((12, 12, 3), np.float32))
    content = (path / "000.tif").read_bytes()
    size, huge = struct.pack("<HII", 3, 1, 12), struct.pack("<HII", 4, 1, 2**30)
    large = content.replace(size, huge)
    assert large != content
    (path / "000.tif").write_bytes(large)
    return path


def an_hdr_that_claims_to_be_huge(folder):
    path = sphere_photos(folder)
    (path / "000.png").unlink()
    text = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2000000000 +X 2000000000\n"
    (path / "000.hdr").write_bytes(text + b"\2\2" * 100)
    return path


def an_exr_that_unpacks_to_a_thousandfold(folder):
    path = sphere_exr(folder)
    images.write(path, np.zeros((5000, 5000, 1), np.float32))
    return path


def a_black_image_of_a_large_ball(folder):
    path = sphere_exr(folder)
    images.write(path, np.zeros((1500, 1500, 3), np.float32))
    return edited(path, "resolution = 12", "resolution = 1500")


def a_scene_of_a_camera_with_a_trillion_pixels(folder):
    path = sphere_exr(folder)
    return edited(path, "resolution = 12", "resolution = 1000000")


def a_scene_with_a_resolution_beyond_all_integers(folder):
    path = sphere_exr(folder)
    return edited(path, "resolution = 12", f"resolution = {'9' * 5000}")


def a_scene_nested_ten_thousand_deep(folder):
    path = sphere_exr(folder)
    sidecar = path.with_suffix(".toml")
    sidecar.write_text(f"camera = {'[' * 10_000}{']' * 10_000}\n")
    return path


def a_scene_of_dotted_keys_without_end(folder):
    path = sphere_exr(folder)
    path.with_suffix(".toml").write_text(f"{'a.' * 20_000}a = 1\n")
    return path


def a_scene_of_ten_thousand_lights(folder):
    path = sphere_exr(folder)
    light = "[[lights]]\nkind = 'directional'\ndirection = [0.0, 0.0, 1.0]\n"
    with path.with_suffix(".toml").open("a") as stream:
        stream.write(light * 9_999)
    return path


def a_scene_of_a_million_lights(folder):
    path = sphere_exr(folder)
    path.with_suffix(".toml").write_text(
        '[camera]\nkind = "orthographic"\nresolution = 12\n'
        "[[shapes]]\nkind = 'sphere'\n" + "[[lights]]\n" * 1_000_000
    )
    return path


def a_scene_that_is_a_device(folder):
    path = sphere_exr(folder)
    return linked(path, path.with_suffix(".toml"), "/dev/zero")


def a_scene_that_links_to_itself(folder):
    path = sphere_exr(folder)
    return linked(path, path.with_suffix(".toml"), "specimen.toml")


def a_scene_that_waits_for_a_writer(folder):
    path = sphere_exr(folder)
    path.with_suffix(".toml").unlink()
    os.mkfifo(path.with_suffix(".toml"))
    return path


def a_stack_with_a_scene_that_is_a_device(folder):
    path = exr_stack(folder)
    return linked(path, path / "a.toml", "/dev/zero")


def a_stack_with_an_image_that_waits_for_a_writer(folder):
    path = exr_stack(folder)
    (path / "a.exr").unlink()
    os.mkfifo(path / "a.exr")
    return path


def a_photograph_that_is_a_device(folder):
    path = sphere_photos(folder)
    return linked(path, path / "000.png", "/dev/zero")


def intensities_that_are_a_device(folder):
    path = sphere_photos(folder)
    return linked(path, path / "light_intensities.txt", "/dev/zero")


def intensities_that_lead_nowhere(folder):
    path = sphere_photos(folder)
    return linked(path, path / "light_intensities.txt", "nowhere")


def light_directions_without_end(folder):
    path = sphere_photos(folder)
    (path / "light_directions.txt").write_text("0 0 1\n" * 1_000_000)
    return path


def a_list_of_a_million_photographs(folder):
    path = sphere_photos(folder)
    (path / "filenames.txt").write_text("000.png\n" * 1_000_000)
    return path


def directions_of_no_photograph_in_curet(folder):
    path = curet(folder)
    return linked(path, path / "table.txt", "/dev/zero")


def normals(kind):
    """A trap in the MATLAB file of normals."""

    def trap(folder):
        path = sphere_photos(folder)
        array = {
            "letters": np.full((12, 12, 3), "a"),
            "cells": np.empty((12, 12, 3), object),
            "complex_numbers": np.ones((12, 12, 3), complex),
            "another_size": np.zeros((5000, 5000)),
            "nothing_finite": np.full((12, 12, 3), np.nan),
        }[kind]
        if array.dtype == object:
            array.fill("a")
        stream = io.BytesIO()
        scipy.io.savemat(stream, {"Normal_gt": array}, do_compression=True)
        (path / "Normal_gt.mat").write_bytes(stream.getvalue())
        return path

    trap.__name__ = f"normals_of_{kind}"
    return trap


def list_of(name):
    """A list of photographs that leads out of its folder."""

    def trap(folder):
        path = sphere_photos(folder)
        (path / "filenames.txt").write_text(f"{name}\n001.png\n002.png\n")
        return path

    trap.__name__ = f"a_list_with_{name[:24]!r}"
    return trap


def scene_with(key, name):
    """A scene with a map, a mesh or a probe out of its folder."""
    tables = {
        "height": f'[[shapes]]\nkind = "sphere"\nheight = {{map = "{name}"}}',
        "mesh": f'[[shapes]]\nkind = "mesh"\nfile = "{name}"',
        "probe": f'[[shapes]]\nkind = "sphere"\n'
        f'[[lights]]\nkind = "environment"\nmap = "{name}"',
    }
    camera = '[camera]\nkind = "orthographic"\nresolution = 12\n'
    light = '[[lights]]\nkind = "directional"\ndirection = [0.0, 0.0, 1.0]\n'

    def trap(folder):
        path = sphere_exr(folder)
        text = f"{camera}{tables[key]}\n{light if key != 'probe' else ''}"
        path.with_suffix(".toml").write_text(text)
        return path

    trap.__name__ = f"a_{key}_of_{name[:24]!r}"
    return trap


def sparse(name, make):
    """A file of a format with a hundred megabytes of holes after it."""

    def trap(folder):
        path = make(folder)
        os.truncate(path, 10**8)
        return path

    trap.__name__ = f"{name}_with_many_zeros"
    return trap


def link_or_pipe(kind):
    """In place of a file something that must not be opened."""

    def trap(folder):
        path = folder / "specimen.binary"
        if kind == "pipe":
            os.mkfifo(path)
        else:
            path.symlink_to({"device": "/dev/zero", "loop": path.name}[kind])
        return path

    trap.__name__ = f"a_{kind}"
    return trap


def edited(path, old, new):
    """The scene beside an image with another text in it."""
    sidecar = path.with_suffix(".toml")
    text = sidecar.read_text()
    assert old in text
    sidecar.write_text(text.replace(old, new))
    return path


def linked(path, file, target):
    """A file replaced by a link."""
    file.unlink()
    file.symlink_to(target)
    return path


def merl_of_huge_dimensions(folder):
    path = merl(folder)
    with path.open("r+b") as stream:
        stream.write(np.full(3, 2**31 - 1, "<i4").tobytes())
    return path


TRAPS = (
    a_photograph_that_claims_to_be_huge,
    a_photograph_that_unpacks_to_a_thousandfold,
    a_photograph_as_large_as_is_let_through,
    a_mask_that_unpacks_to_a_thousandfold,
    black_photographs_of_a_large_ball,
    a_tiff_that_claims_to_be_huge,
    an_hdr_that_claims_to_be_huge,
    an_exr_that_unpacks_to_a_thousandfold,
    a_black_image_of_a_large_ball,
    a_scene_of_a_camera_with_a_trillion_pixels,
    a_scene_with_a_resolution_beyond_all_integers,
    a_scene_nested_ten_thousand_deep,
    a_scene_of_dotted_keys_without_end,
    a_scene_of_ten_thousand_lights,
    a_scene_of_a_million_lights,
    a_scene_that_is_a_device,
    a_scene_that_links_to_itself,
    a_scene_that_waits_for_a_writer,
    a_stack_with_a_scene_that_is_a_device,
    a_stack_with_an_image_that_waits_for_a_writer,
    a_photograph_that_is_a_device,
    intensities_that_are_a_device,
    intensities_that_lead_nowhere,
    light_directions_without_end,
    a_list_of_a_million_photographs,
    directions_of_no_photograph_in_curet,
    merl_of_huge_dimensions,
    *(normals(kind) for kind in ("letters", "cells", "complex_numbers")),
    *(normals(kind) for kind in ("another_size", "nothing_finite")),
    *(list_of(name) for name in OUTSIDE if name),
    *(scene_with("height", name) for name in OUTSIDE),
    *(scene_with("mesh", name) for name in OUTSIDE[:3]),
    *(scene_with("probe", name) for name in OUTSIDE[:3]),
    *(link_or_pipe(kind) for kind in ("device", "loop", "pipe")),
    sparse("fred", fred),
    sparse("table", SPECIMENS["table"]),
    sparse("rgl", rgl),
    sparse("utia", utia),
    sparse("merl", merl),
)

"""A download that goes on where it was interrupted."""

from collections.abc import Callable
from pathlib import Path
from urllib.parse import urlsplit

import requests

CHUNK = 2**18  # bytes
PATIENCE = 30  # seconds without a sign of the server
NOT_FOUND, WRONG_RANGE, PARTIAL = 404, 416, 206

Progress = Callable[[int, int | None], None]


def download(
    url: str, part: Path, progress: Progress | None = None, hint: str = ""
) -> None:
    """Download into a file, continuing what is there already.

    Beside it stands, until the end, a file with the server's mark of the version, so
    that parts of two versions are never joined.

    Args:
        url: What to download.
        part: Where to write; complete when this returns.
        progress: Called with the bytes that are there and the number of all.
        hint: What to say to who asked for something that is not there.

    Raises:
        OSError: The server cannot be reached, refuses, or stopped half-way; what has
            come is kept then.
    """
    mark = part.with_name(f"{part.name}.version")
    host = urlsplit(url).netloc
    try:
        answer = _request(url, part, mark)
    except requests.exceptions.RequestException as error:
        raise OSError(
            f"Server {host} cannot be reached ({type(error).__name__}): check the "
            f"network and the address {url}."
        ) from error
    with answer:
        if answer.status_code == NOT_FOUND:
            raise FileNotFoundError(f"There is no {url}; {hint}.")
        if not answer.ok:
            raise OSError(
                f"Server {host} refuses {url}: {answer.status_code} {answer.reason}."
            )
        try:
            _receive(answer, part, mark, progress)
        except requests.exceptions.RequestException as error:
            raise OSError(
                f"Server {host} stopped half-way through {url}; run this again to go "
                f"on where it stopped."
            ) from error
    mark.unlink(missing_ok=True)


def _receive(
    answer: requests.Response, part: Path, mark: Path, progress: Progress | None
) -> None:
    """Write what comes to the end of a part, or in its place."""
    done = part.stat().st_size if answer.status_code == PARTIAL else 0
    if not done:
        mark.write_text(_version(answer))
    length = answer.headers.get("Content-Length", "")
    total = done + int(length) if length.isdigit() else None
    with part.open("ab" if done else "wb") as stream:
        for chunk in answer.iter_content(CHUNK):
            stream.write(chunk)
            done += len(chunk)
            if progress:
                progress(done, total)


def _request(url: str, part: Path, mark: Path) -> requests.Response:
    """The answer of a server, to a request for the rest where a part is there."""
    headers = {"Accept-Encoding": "identity"}  # so that places in it are bytes
    known = mark.read_text() if mark.is_file() else ""
    if part.is_file() and part.stat().st_size and known:
        rest = headers | {"Range": f"bytes={part.stat().st_size}-", "If-Range": known}
        answer = requests.get(url, headers=rest, stream=True, timeout=PATIENCE)
        if answer.status_code != WRONG_RANGE:
            return answer
        answer.close()
    return requests.get(url, headers=headers, stream=True, timeout=PATIENCE)


def _version(answer: requests.Response) -> str:
    """The server's mark of this version of a file; empty when it has none."""
    tag = answer.headers.get("ETag", "")
    weak = tag.startswith("W/")
    return answer.headers.get("Last-Modified", "") if weak or not tag else tag

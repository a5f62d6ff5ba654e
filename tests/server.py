"""A server on this machine, for tests of downloads; it can be told to misbehave."""

import contextlib
import http.server
import threading


class Server(http.server.ThreadingHTTPServer):
    """Serves what is in ``files``, by path.

    Attributes:
        files: Content by path.
        stop_after: Bytes after which an answer is broken off, or None.
        version: Mark of the version of all files.
        ranges: The ranges that were asked for.
        requests: Number of requests.
    """

    def __init__(self):
        super().__init__(("127.0.0.1", 0), Handler)
        self.files, self.stop_after, self.version = {}, None, '"1"'
        self.ranges, self.requests = [], 0

    @property
    def url(self):
        return f"http://127.0.0.1:{self.server_port}/"


class Handler(http.server.BaseHTTPRequestHandler):
    def do_GET(self):  # noqa: N802  (the name that is asked for)
        server = self.server
        server.requests += 1
        content = server.files.get(self.path)
        if content is None:
            self.send_error(404)
            return
        start, wanted = 0, self.headers.get("Range")
        if wanted and self.headers.get("If-Range") == server.version:
            start = int(wanted.removeprefix("bytes=").removesuffix("-"))
            server.ranges.append(start)
        self.send_response(206 if start else 200)
        self.send_header("Content-Length", str(len(content) - start))
        self.send_header("ETag", server.version)
        self.end_headers()
        body = content[start:]
        self.wfile.write(body[: server.stop_after])

    def log_message(self, *_):
        pass


@contextlib.contextmanager
def serving():
    """A server that runs until the block ends."""
    server = Server()
    thread = threading.Thread(
        target=server.serve_forever, kwargs={"poll_interval": 0.01}
    )
    thread.start()
    try:
        yield server
    finally:
        server.shutdown()
        server.server_close()
        thread.join()

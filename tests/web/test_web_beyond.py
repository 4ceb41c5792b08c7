"""The page beyond this machine: its token, what browsers keep of it, and a path of a server in front of it."""

import http.client
import json
import threading
import time
import urllib.parse
from contextlib import contextmanager

import pytest
import uvicorn

from rockflex.cli import _app as cli
from rockflex.motion._columns import record_csv
from rockflex.web import make_app
from rockflex.web._uploads import read_uploaded_record


@contextmanager
def serving(app, **options):
    """The port of a server."""
    running = uvicorn.Server(uvicorn.Config(app, port=0, log_level="error", **options))
    thread = threading.Thread(target=running.run, daemon=True)
    thread.start()
    while not running.started:
        assert thread.is_alive()
        time.sleep(0.02)
    yield running.servers[0].sockets[0].getsockname()[1]
    running.should_exit = True
    thread.join(10)


def asked(port, path, **headers):
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=60)
    connection.request("GET", path, headers=headers)
    answer = connection.getresponse()
    found = answer.status, answer.headers, answer.read()
    connection.close()
    return found


def test_a_token_opens_the_page_once_and_a_cookie_from_then_on() -> None:
    with serving(make_app(token="secret")) as port:
        for path in ("/", "/api/about", "/static/main.js", "/?token=secre", "/?token=", "/api/file/x/content"):
            assert asked(port, path)[0] == 403
        status, headers, _ = asked(port, "/?lang=de&token=secret")
        assert (status, headers["location"]) == (303, "./?lang=de")
        cookie = headers["set-cookie"]
        assert {"HttpOnly", "SameSite=strict"} <= {each.strip() for each in cookie.split(";")}
        for path in ("/", "/api/about", "/static/main.js"):
            assert asked(port, path, Cookie=cookie.partition(";")[0])[0] == 200
        name = cookie.partition("=")[0]
        assert asked(port, "/", Cookie=f"{name}=wrong")[0] == 403


@pytest.mark.parametrize(
    ("host", "no_token", "given"),
    [("127.0.0.1", False, False), ("0.0.0.0", False, True), ("::", False, True), ("0.0.0.0", True, False)],
)
def test_it_is_made_for_addresses_that_others_reach(monkeypatch, host, no_token, given) -> None:
    made = []
    monkeypatch.setattr("rockflex.web._serve.serve", lambda *_, token, **__: made.append(token))
    for _ in range(2):
        cli.serve(host=host, no_token=no_token)
    assert [len(token) > 20 for token in made] == [given] * 2
    assert (made[0] != made[1]) == given


def test_what_is_a_visitors_is_not_kept(client) -> None:
    for path, kept in {"/": "no-cache", "/static/main.js": "no-cache", "/api/about": "no-cache",
                       "/api/file/x": "no-store", "/api/folder/x": "no-store"}.items():  # fmt: skip
        assert client.request(path)[1]["cache-control"] == kept
    _, headers, _ = client.request("/api/state", json.dumps({"state": client.state()}).encode(),
                                   Content_Type="application/json")  # fmt: skip
    assert headers["cache-control"] == "no-store"


def test_a_server_in_front_has_the_page_under_a_path() -> None:
    with serving(make_app(), root_path="/rocking") as port:  # which the server in front removes
        page = asked(port, "/")[2].decode()
        links = [part.partition('"')[0] for each in ("src=", "href=") for part in page.split(f'{each}"')[1:]]
        links = [link for link in links if not link.startswith("#")]
        assert "static/main.js" in links
        for link in links:
            under = urllib.parse.urljoin("http://page.example/rocking/", link)
            path = urllib.parse.urlsplit(under).path
            assert path.startswith("/rocking/")
            assert asked(port, path.removeprefix("/rocking"))[0] == 200
        assert asked(port, "/api/about")[0] == 200
        assert asked(port, "/api/folder/x")[1]["cache-control"] == "no-store"


def test_the_csv_of_an_uploaded_record_names_the_visitors_file() -> None:
    content = b"time (s),acc (g)\n0.00,0.0\n0.01,0.1\n0.02,-0.2\n0.03,0.0\n"
    saved = record_csv(read_uploaded_record("My quake (1).csv", content, None, None))
    assert "My quake (1).csv" in saved

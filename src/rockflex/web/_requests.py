"""The content of requests, and files as answers."""

import re
from typing import Any
from urllib.parse import quote

import anyio
from starlette.requests import Request
from starlette.responses import Response

from rockflex.web._limits import MAX_BODY_BYTES, MAX_FILE_BYTES, unclear_commas_text
from rockflex.web._refusal import Refusal
from rockflex.web._state import PageState, parse_page_json, parse_page_state

BODY_TIMEOUT = 60.0  # s to receive a body
MAX_INLINE_BYTES = 20_000  # bytes that are checked within a few milliseconds; more would block the event loop


async def state_in_request(request: Request) -> PageState:
    """Return the state in a request.

    Raises
    ------
    Refusal
        If there is none, or it cannot be used.
    """
    return (await state_and_request_content(request))[0]


async def state_and_request_content(request: Request) -> tuple[PageState, dict[str, Any]]:
    """Return the state in a request, and all of its content.

    Raises
    ------
    Refusal
        As `state_in_request`.
    """
    body = await _request_body(request, "application/json")
    if len(body) <= MAX_INLINE_BYTES:
        return _parse_request_body(body)
    return await anyio.to_thread.run_sync(_parse_request_body, body)


async def uploaded_file_bytes(request: Request, most: int = MAX_BODY_BYTES, said: int = MAX_FILE_BYTES) -> bytes:
    """Return the bytes of an uploaded file, of at most `most`; messages name the limit `said`."""
    return await _request_body(request, "application/octet-stream", most, said)


async def _request_body(request: Request, wanted: str, most: int = MAX_BODY_BYTES, said: int = MAX_FILE_BYTES) -> bytes:
    """Return the body of a request, within the limits of its size and its time.

    Another content type would let foreign pages send it unasked, without the browser's preflight.
    """
    if request.headers.get("content-type", "").split(";")[0].strip().lower() != wanted:
        raise Refusal(f"A request must be {wanted}.", 415)
    chunks, size = list[bytes](), 0
    try:
        with anyio.fail_after(BODY_TIMEOUT):
            async for chunk in request.stream():
                size += len(chunk)
                if size <= most:
                    chunks.append(chunk)
                elif size > most + 4 * MAX_BODY_BYTES:
                    break
    except TimeoutError as error:
        raise Refusal(f"The request did not arrive within {BODY_TIMEOUT:g} s.", 408) from error
    if size > most:  # the rest was read and dropped, because most clients lose an answer that comes before the end
        raise Refusal(f"More than {said / 1e6:g} MB were sent, which is more than the page takes.", 413)
    return b"".join(chunks)


def _parse_request_body(body: bytes) -> tuple[PageState, dict[str, Any]]:
    content = parse_page_json(body)
    if not isinstance(content, dict):
        raise Refusal("A request must be a JSON object.", 400)
    return parse_page_state(content.get("state")), content


def sampling_step_in_query(text: str, field: str = "record.upload") -> float | None:
    """Return the sampling step in a query; None for the file's own. Messages are about `field`.

    Raises
    ------
    Refusal
        If it is not a number.
    """
    if not text.strip():
        return None
    try:
        return float(text)
    except ValueError as error:
        message = f"the sampling step must be a number in s, but {text[:40]!r} was given.{unclear_commas_text(text)}"
        raise Refusal({field: message}) from error


def file_download_answer(name: str, kind: str, content: bytes) -> Response:
    """Return a file as a download with a name."""
    # A header holds Latin letters only: others are given in the long form, and as underscores in the short one.
    short = re.sub(r"[^ -~]", "_", name)
    disposition = f"attachment; filename=\"{short}\"; filename*=UTF-8''{quote(name)}"
    return Response(content, media_type=kind, headers={"Content-Disposition": disposition})

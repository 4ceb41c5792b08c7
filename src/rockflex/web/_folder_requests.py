"""Requests with a folder of records, and about one that the server has."""

import asyncio
from collections.abc import Awaitable, Callable
from typing import Any, Protocol

from starlette.requests import Request
from starlette.responses import JSONResponse, Response
from starlette.routing import Route

from rockflex.web._exchange import file_of, step_of
from rockflex.web._folders import Folders, read_folder
from rockflex.web._limits import FOLDER
from rockflex.web._unpacking import FIELD, HEAD, unpacked

AT_ONCE = 1  # folders read: each may need some hundred megabytes
ROOM = 3  # folders in memory that are received, or wait to be read: each may have 80 MB


class Answers(Protocol):
    """Computes outside the event loop, a limited number of answers at once."""

    def __call__(self, work: Callable[[], Any], most: int = ...) -> Awaitable[Any]:
        """Compute an answer."""
        ...


def folder_routes(answer: Answers, folders: Folders) -> list[Route]:
    """Return the routes of folders, which are kept in `folders`."""
    room = asyncio.Semaphore(ROOM)

    async def give(request: Request) -> Response:
        async with room:  # others wait with their files on their own machines
            body, query = await file_of(request, FOLDER + HEAD, FOLDER), request.query_params
            units, dt = query.get("units") or None, step_of(query.get("dt", ""), FIELD)

            def work() -> dict[str, Any]:
                files = unpacked(body)
                folder = read_folder(files, units, dt)
                token = folders.add(folder, files, f"{units} {dt}")
                return {"folder": token, **folder.report}

            return JSONResponse(await answer(work, AT_ONCE))

    async def look(request: Request) -> Response:
        token = request.path_params["token"]
        return JSONResponse({"folder": token, **folders.get(token).report})

    return [Route("/api/folder", give, methods=["POST"]), Route("/api/folder/{token}", look)]

"""Requests about a target spectrum, and the records chosen for it."""

from collections.abc import Awaitable, Callable
from typing import Any, Protocol

from starlette.requests import Request
from starlette.responses import JSONResponse, Response
from starlette.routing import Route

from rockflex.web._exchange import question_of
from rockflex.web._target import factor_view, selection_view
from rockflex.web._uploads import Uploads

AT_ONCE = 1  # choices computed: each may take some seconds


class Runs(Protocol):
    """Computes outside the event loop, a limited number of answers at once, as long as the visitor waits."""

    def __call__(self, request: Request, work: Callable[[], Any], most: int = ...) -> Awaitable[Any]:
        """Compute an answer."""
        ...


def target_routes(run: Runs, uploads: Uploads) -> list[Route]:
    """Return the routes of target spectra."""

    async def select(request: Request) -> Response:
        state, _ = await question_of(request)
        return JSONResponse(await run(request, lambda: selection_view(state, uploads), AT_ONCE))

    async def factor(request: Request) -> Response:
        state, content = await question_of(request)
        return JSONResponse(await run(request, lambda: factor_view(state, uploads, content.get("period"))))

    return [
        Route("/api/selection", select, methods=["POST"]),
        Route("/api/factor", factor, methods=["POST"]),
    ]

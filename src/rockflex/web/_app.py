"""The server: requests and answers in JSON, and the files of the page. It does not store a visitor's state."""

import asyncio
import logging
import math
import re
from collections.abc import AsyncGenerator, Callable, Coroutine, Mapping, Sequence
from contextlib import asynccontextmanager
from pathlib import Path
from threading import Thread
from typing import Any, cast, get_args
from urllib.parse import quote

import anyio
from starlette.applications import Starlette
from starlette.middleware import Middleware
from starlette.middleware.gzip import GZipMiddleware
from starlette.requests import ClientDisconnect, Request
from starlette.responses import FileResponse, JSONResponse, Response
from starlette.routing import Mount, Route
from starlette.staticfiles import StaticFiles

from rockflex.engine.stops import RunStoppedError, stopping_when
from rockflex.foundation.errors import InputError, SolverError
from rockflex.foundation.json import as_json_value
from rockflex.foundation.language import CATALOGUES, Language, use_language
from rockflex.foundation.units import QUANTITIES, SystemName, UnitSystem
from rockflex.report.run._report_files import found_browser
from rockflex.response._outputs import HISTORY, OUTPUTS, Output
from rockflex.structure._outline import DARK_ELEMENT_COLORS, ELEMENT_COLORS
from rockflex.studies._compare import MAX_ALTERNATIVES
from rockflex.web import _limits as limits
from rockflex.web._alternatives import alternatives_view
from rockflex.web._connections import BoundedBodies
from rockflex.web._downloads import MEDIA_TYPES, PAGES, Progress, file_maker, study_file_maker
from rockflex.web._earthquake import PULSES, embedded_suite_names, record_view, suite_view
from rockflex.web._folders import FIELD, MAX_LIST_BYTES
from rockflex.web._forms import FIRST, PRESETS, forms_of_structures
from rockflex.web._jobs import MAX_FILES, MAX_FILES_WRITTEN, MAX_STUDIES, BackgroundFileJob, BackgroundJobs, RunsJob
from rockflex.web._links import usable_page_state
from rockflex.web._projects import read_project
from rockflex.web._protection import KnownHosts, SecurityHeaders, TokenRequired
from rockflex.web._readers import Readers
from rockflex.web._record_sets import periods_view
from rockflex.web._refusal import Refusal
from rockflex.web._response import response_view, sketch_view
from rockflex.web._selection import scale_factor_view, selection_view
from rockflex.web._site import site_view
from rockflex.web._slots import Slots, visitor_left, visitor_of
from rockflex.web._state import PageState, limit_state_labels, measure_labels, parse_page_json, parse_page_state
from rockflex.web._structure import structure_view
from rockflex.web._uploads import (
    UploadedRecords,
    read_sent_folder,
    read_uploaded_matrices,
    read_uploaded_record,
    read_uploaded_vertical,
)

STATIC = Path(__file__).parent / "static"
MAX_ANSWERS = 4  # answers computed at once: the engine releases the lock, and short answers must not wait for long ones
MAX_READ = 2  # files read at once, beside the answers: most of it holds the lock
MAX_FOLDERS_READ = 1  # folders read at once: each may need some hundred megabytes
FOLDER_SECONDS = 60.0  # to read one
MAX_FOLDERS_RECEIVED = 3  # folders in memory that are received, or wait to be read: each may have 80 MB
MAX_SELECTIONS_COMPUTED = 1  # selections at once: each may take some seconds
MAX_MESSAGE_LETTERS = 1000  # of a message: some repeat an input
BODY_TIMEOUT = 60.0  # s to receive a body
END = 1.5  # s for the files that are written when the server is stopped: within the seconds that `serve` waits
MAX_INLINE_BYTES = 20_000  # bytes that are checked within a few milliseconds; more would block the event loop
Answer = Callable[[], Any]
Endpoint = Callable[[Request], Coroutine[Any, Any, Response]]


class PageServer:
    """The requests of the page; only uploads and running studies are stored."""

    def __init__(self) -> None:
        self.uploads = UploadedRecords()
        self.jobs = BackgroundJobs[RunsJob]("studies", MAX_STUDIES)
        self.files = BackgroundJobs[BackgroundFileJob]("files", MAX_FILES, MAX_FILES_WRITTEN)
        self._folders_received = asyncio.Semaphore(MAX_FOLDERS_RECEIVED)
        self.answers, self.selections = Slots(MAX_ANSWERS), Slots(MAX_SELECTIONS_COMPUTED)
        self.readers = Readers()
        self.readings, self.folders_read = Slots(MAX_READ), Slots(MAX_FOLDERS_READ)
        self._threads = anyio.CapacityLimiter(math.inf)  # the slots limit them

    def warm_up(self) -> None:
        """Import the modules and prepare the engine before the first visitor needs them."""
        pulse = {"source": "pulse", "pulse": {"shape": "one_sine", "amplitude": 5.0, "period": 0.5}}
        content = {"structure": PRESETS[0]["structure"], "record": pulse, "free_vibration": 0.0}
        state = PageState.model_validate(content | {"models": ["MDOF-S", "2DOF-S", "2DOF-C", "fixed"]})
        response_view(state, self.uploads)

    async def run(self, request: Request, work: Answer, slots: Slots | None = None) -> Any:
        """Compute outside the event loop, a limited number of answers at once, until the visitor no longer waits."""
        async with (slots or self.answers).place(request) as gone:

            def guarded() -> Any:
                with stopping_when(gone.is_set):
                    return work()

            try:
                return await anyio.to_thread.run_sync(guarded, limiter=self._threads, abandon_on_cancel=True)
            except RunStoppedError as error:
                raise visitor_left() from error
            except asyncio.CancelledError as error:  # at the end of the server, which would print its traceback
                raise Refusal("The server was stopped.", 503) from error

    async def about(self, _: Request) -> Response:
        """Forms, presets, suites, pulses, units and limits."""
        return JSONResponse(await anyio.to_thread.run_sync(_answer_about_page))

    async def suite(self, request: Request) -> Response:
        """Records of a suite."""
        name = request.path_params["name"]
        return JSONResponse(await anyio.to_thread.run_sync(suite_view, name))

    async def state(self, request: Request) -> Response:
        """Check the state of a link, and fill in its missing values; one that is refused opens as far as it can."""
        body = await _request_body(request, "application/json")
        return await anyio.to_thread.run_sync(_opened_link, body)

    def view(self, work: Callable[[PageState, dict[str, Any]], Any], slots: Slots | None = None) -> Endpoint:
        """Return the endpoint that answers with a function of the state, and of the whole content, of a request."""

        async def endpoint(request: Request) -> Response:
            state, content = await _state_and_content(request)
            with use_language(state.language):
                return JSONResponse(await self.run(request, lambda: work(state, content), slots))

        return endpoint

    async def upload(self, request: Request) -> Response:
        """A record from an uploaded file, or the vertical component of the record `under`; its name is in the query."""
        body, query = await uploaded_file_bytes(request), request.query_params
        name, units = query.get("name", "record"), query.get("units") or None
        dt, under = _sampling_step_in_query(query.get("dt", "")), query.get("under", "")

        def work() -> Any:
            if under:
                along = self.uploads.get(under)
                motion = self.readers.read("record.vertical", read_uploaded_vertical, name, body, units, dt, along)
            else:
                motion = self.readers.read("record.upload", read_uploaded_record, name, body, units, dt)
            key = self.uploads.add(motion, body, f"{units} {dt} {motion.name} {under}")
            facts = {"samples": motion.acceleration.size, "pga": motion.pga, "pva": motion.pva}
            return as_json_value({"upload": key, "name": motion.name, **facts})

        return JSONResponse(await self.run(request, work, self.readings))

    async def folder(self, request: Request) -> Response:
        """Records from a folder."""
        async with self._folders_received:  # others wait with their files on their own machines
            query, most = request.query_params, limits.MAX_FOLDER_BYTES
            body = await uploaded_file_bytes(request, most + MAX_LIST_BYTES, most)
            units, dt = query.get("units") or None, _sampling_step_in_query(query.get("dt", ""), FIELD)
            language = cast("Language | None", query.get("language"))

            def work() -> dict[str, Any]:
                token, folder = self.readers.read(
                    FIELD, read_sent_folder, body, units, dt, seconds=FOLDER_SECONDS, language=language
                )
                self.uploads.folders.put(token, folder)
                return {"folder": token, **folder.report}

            return JSONResponse(await self.run(request, work, self.folders_read))

    async def project(self, request: Request) -> Response:
        """The state in a project's file."""
        async with self._folders_received:
            body = await uploaded_file_bytes(request, limits.MAX_PROJECT_BYTES, limits.MAX_PROJECT_BYTES)

            def work() -> dict[str, Any]:
                answer, records = self.readers.read("project", read_project, body, seconds=FOLDER_SECONDS)
                self.uploads.take(records)
                return answer

            return JSONResponse(await self.run(request, work, self.folders_read))

    async def folder_report(self, request: Request) -> Response:
        """Report on a folder that the server has."""
        token = request.path_params["token"]
        return JSONResponse({"folder": token, **self.uploads.folders.get(token).report})

    async def matrices(self, request: Request) -> Response:
        """Matrices from a file."""
        body, query = await uploaded_file_bytes(request), request.query_params
        name, part = query.get("name", "matrices"), query.get("part", "")

        def work() -> dict[str, Any]:
            return self.readers.read("structure", read_uploaded_matrices, name, body, part)

        return JSONResponse(await self.run(request, work, self.readings))

    async def start(self, request: Request) -> Response:
        """Start a study."""
        kind = _study_kind_in_request(request)
        state, _ = await _state_and_content(request)

        def work() -> dict[str, str]:
            job = PAGES[kind].job(PAGES[kind].study(state, self.uploads), kind)
            return {"token": self.jobs.start(job, visitor_of(request))}

        return JSONResponse(await self.run(request, work))

    async def progress(self, request: Request) -> Response:
        """Progress of a study, and its results so far for the limit states of the page."""
        kind, job = self._job(request)
        state, _ = await _state_and_content(request)
        with use_language(state.language):
            return JSONResponse(await self.run(request, lambda: PAGES[kind].view(job, state)))

    async def study_file(self, request: Request) -> Response:
        """Start to make the table, the figure or the report of a study."""
        kind, job = self._job(request)
        state, _ = await _state_and_content(request)
        what = request.path_params["what"]
        return self._making(request, study_file_maker(PAGES[kind], job, state, what), state)

    async def make(self, request: Request) -> Response:
        """Start to make a file of the results on the page."""
        state, _ = await _state_and_content(request)
        return self._making(request, file_maker(state, request.path_params["what"], self.uploads), state)

    def _making(self, request: Request, make: Callable[[Progress], tuple[str, bytes]], state: PageState) -> Response:
        def styled(told: Progress) -> tuple[str, bytes]:
            from rockflex.plot._figures import figure_style

            with figure_style(units=state.units, language=state.language):
                return make(told)

        return JSONResponse({"token": self.files.start(BackgroundFileJob(styled), visitor_of(request))})

    async def making(self, request: Request) -> Response:
        """Progress of a file."""
        job = self.files.get(request.path_params["token"])
        errors = job.errors or ({"": job.message} if job.message else {})
        return JSONResponse({"status": job.status, "done": job.done, "total": job.total, "errors": errors})

    async def made(self, request: Request) -> Response:
        """Hand out a file that was made; the page says when it has arrived, and it is forgotten only then."""
        made = self.files.get(request.path_params["token"]).file
        if made is None:
            raise Refusal("The file is not finished, or was handed out already.", 404)
        name, content = made
        return _file_answer(name, MEDIA_TYPES[Path(name).suffix], content)

    async def cancel(self, request: Request) -> Response:
        """Stop a study, or to make a file, or forget one that has arrived."""
        jobs = self.files if request.url.path.startswith("/api/file/") else self.jobs
        jobs.cancel(request.path_params["token"])
        return JSONResponse({})

    def _job(self, request: Request) -> tuple[str, RunsJob]:
        kind, job = _study_kind_in_request(request), self.jobs.get(request.path_params["token"])
        if job.kind != kind:
            raise Refusal(f"That study is not a {kind} study.", 404)
        return kind, job


def _study_kind_in_request(request: Request) -> str:
    kind = request.path_params["kind"]
    if kind not in PAGES:
        raise Refusal(f"There is no study of the kind {kind[:40]!r}.", 404)
    return kind


async def _state_and_content(request: Request) -> tuple[PageState, dict[str, Any]]:
    """Return the state in a request, checked, and all of its content."""
    body = await _request_body(request, "application/json")
    if len(body) <= MAX_INLINE_BYTES:
        return _parse_request_body(body)
    return await anyio.to_thread.run_sync(_parse_request_body, body)


async def uploaded_file_bytes(
    request: Request, most: int = limits.MAX_BODY_BYTES, said: int = limits.MAX_FILE_BYTES
) -> bytes:
    """Return the bytes of an uploaded file, of at most `most`; messages name the limit `said`."""
    return await _request_body(request, "application/octet-stream", most, said)


async def _request_body(
    request: Request, wanted: str, most: int = limits.MAX_BODY_BYTES, said: int = limits.MAX_FILE_BYTES
) -> bytes:
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
                elif size > most + 4 * limits.MAX_BODY_BYTES:
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


def _opened_link(body: bytes) -> Response:
    try:
        state, _ = _parse_request_body(body)
    except Refusal as error:
        if error.status != 422:
            raise
        content = parse_page_json(body).get("state")
        opened = usable_page_state(content, FIRST["structure"]) if isinstance(content, dict) else None
        return JSONResponse({"errors": _shortened(error), "state": as_json_value(opened)}, error.status)
    return JSONResponse(as_json_value(state.model_dump(exclude_none=True)))


def _sampling_step_in_query(text: str, field: str = "record.upload") -> float | None:
    """Return the sampling step in a query; None for the file's own. Messages are about `field`."""
    if not text.strip():
        return None
    try:
        return float(text)
    except ValueError as error:
        message = (
            f"the sampling step must be a number in s, but {text[:40]!r} was given.{limits.unclear_commas_text(text)}"
        )
        raise Refusal({field: message}) from error


def _file_answer(name: str, kind: str, content: bytes) -> Response:
    """Return a file as a download with a name."""
    # A header holds Latin letters only: others are given in the long form, and as underscores in the short one.
    short = re.sub(r"[^ -~]", "_", name)
    disposition = f"attachment; filename=\"{short}\"; filename*=UTF-8''{quote(name)}"
    return Response(content, media_type=kind, headers={"Content-Disposition": disposition})


def create_page_application(host: str, names: Sequence[str], token: str = "") -> Starlette:
    """Return the application for a host name; it answers to that and to some others (`KnownHosts`), with a token."""
    server = PageServer()
    view, uploads = server.view, server.uploads

    def structure(state: PageState, content: dict[str, Any]) -> Any:
        quick = content.get("quick") is True
        view = structure_view(state.structure, state.ground, quick=quick)
        return {**view, "run": sketch_view(state, uploads, quick=quick)}

    def response(state: PageState, content: dict[str, Any]) -> Any:
        return response_view(state, uploads, content.get("focus"), content.get("element"))

    def selection(state: PageState, _: dict[str, Any]) -> Any:
        return selection_view(state, uploads)

    def factor(state: PageState, content: dict[str, Any]) -> Any:
        return scale_factor_view(state, uploads, content.get("period"))

    @asynccontextmanager
    async def lifespan(_: Starlette) -> AsyncGenerator[None]:
        Thread(target=server.warm_up, name="warm-up", daemon=True).start()
        yield
        server.jobs.close()
        server.files.close()
        server.readers.close()
        server.files.wait(END)  # Python ends threads by force, which aborts the process where one draws in C++

    middleware = [
        Middleware(SecurityHeaders),
        Middleware(KnownHosts, host=host, names=names),
        *([Middleware(TokenRequired, token=token)] if token else []),
        Middleware(BoundedBodies),
        Middleware(GZipMiddleware, minimum_size=1000, compresslevel=3),
    ]
    routes = [
        Route("/", _page_html),
        Route("/api/about", server.about),
        Route("/api/suite/{name}", server.suite),
        Route("/api/state", server.state, methods=["POST"]),
        Route("/api/structure", view(structure), methods=["POST"]),
        Route("/api/record", view(lambda state, _: record_view(state, uploads)), methods=["POST"]),
        Route("/api/response", view(response), methods=["POST"]),
        Route("/api/alternatives", view(lambda state, _: alternatives_view(state, uploads)), methods=["POST"]),
        Route("/api/project", server.project, methods=["POST"]),
        Route("/api/upload", server.upload, methods=["POST"]),
        Route("/api/folder", server.folder, methods=["POST"]),
        Route("/api/folder/{token}", server.folder_report),
        Route("/api/selection", view(selection, server.selections), methods=["POST"]),
        Route("/api/factor", view(factor), methods=["POST"]),
        Route("/api/periods", view(lambda state, _: periods_view(state, uploads)), methods=["POST"]),
        Route("/api/site", view(lambda state, _: site_view(state, uploads), server.selections), methods=["POST"]),
        Route("/api/matrices", server.matrices, methods=["POST"]),
        Route("/api/study/{kind}", server.start, methods=["POST"]),
        Route("/api/study/{kind}/{token}", server.progress, methods=["POST"]),
        Route("/api/study/{kind}/{token}/{what}", server.study_file, methods=["POST"]),
        Route("/api/job/{token}", server.cancel, methods=["DELETE"]),
        Route("/api/file/{token}", server.cancel, methods=["DELETE"]),
        Route("/api/file/{what}", server.make, methods=["POST"]),
        Route("/api/file/{token}", server.making),
        Route("/api/file/{token}/content", server.made),
        Route("/static/elements.css", _element_colors),
        Mount("/static", StaticFiles(directory=STATIC)),
        Mount("/languages", StaticFiles(directory=CATALOGUES)),
    ]
    handlers: dict[Any, Any] = {
        Refusal: _answer_to_refusal,
        InputError: _answer_to_unusable_input,
        SolverError: _answer_to_unusable_input,
        ClientDisconnect: _answer_to_gone_client,
        Exception: _answer_to_failure,
    }
    return Starlette(routes=routes, middleware=middleware, exception_handlers=handlers, lifespan=lifespan)


async def _page_html(_: Request) -> Response:
    return FileResponse(STATIC / "index.html")


async def _element_colors(_: Request) -> Response:
    themes = {":root": ELEMENT_COLORS, ':root[data-theme="dark"]': DARK_ELEMENT_COLORS}
    rules = (
        f"{theme} {{ {' '.join(f'--{name}: {color};' for name, color in colors.items())} }}\n"
        for theme, colors in themes.items()
    )
    return Response("".join(rules), media_type="text/css")


def _answer_about_page() -> dict[str, Any]:
    usual = ("amplitude", "period")
    pulses = {name: {"title": each.title, "fields": (*usual, *each.fields)} for name, each in PULSES.items()}
    most = {
        "file": limits.MAX_FILE_BYTES,
        "files": limits.MAX_FOLDER_FILES,
        "folder": limits.MAX_FOLDER_BYTES,
        "duration": limits.MAX_DURATION,
        "models": limits.MAX_MODELS,
        "elements": limits.MAX_ELEMENTS,
        "alternatives": MAX_ALTERNATIVES,
        "project": limits.MAX_PROJECT_BYTES,
    }
    first = PageState.model_validate(FIRST)
    return forms_of_structures() | {
        "suites": embedded_suite_names(),
        "measures": measure_labels(),
        "limit_states": limit_state_labels(),
        "pulses": pulses,
        "limits": most,
        "units": {
            name: {quantity: UnitSystem(name).of(quantity)._asdict() for quantity in QUANTITIES}
            for name in get_args(SystemName)
        },
        "outputs": _described(OUTPUTS),
        "histories": _described(HISTORY),
        "pdf": found_browser() is not None,
        "state": as_json_value(first.model_dump(exclude_none=True)),
    }


def _described(outputs: Mapping[str, Output]) -> dict[str, dict[str, str]]:
    return {
        name: {"symbol": each.symbol, "quantity": each.quantity, "words": each.words, "of": each.of}
        for name, each in outputs.items()
    }


async def _answer_to_refusal(_: Request, error: Exception) -> Response:
    assert isinstance(error, Refusal)
    return JSONResponse({"errors": _shortened(error)}, status_code=error.status)


def _shortened(error: Refusal) -> dict[str, str]:
    return {path[:200]: text[:MAX_MESSAGE_LETTERS] for path, text in error.errors.items()}


async def _answer_to_unusable_input(_: Request, error: Exception) -> Response:
    return JSONResponse({"errors": {"": str(error)[:MAX_MESSAGE_LETTERS]}}, status_code=422)


async def _answer_to_gone_client(_: Request, __: Exception) -> Response:
    return Response(status_code=400)  # the visitor left during the request, and nobody reads this


async def _answer_to_failure(_: Request, error: Exception) -> Response:
    logging.getLogger(__name__).error("Internal error", exc_info=error)
    message = "An internal error occurred; the log of the server has the details."
    return JSONResponse({"errors": {"": message}}, status_code=500)

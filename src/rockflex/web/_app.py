"""The server: requests and answers in JSON, and the files of the page. It does not store a visitor's state."""

import asyncio
import logging
from collections.abc import AsyncGenerator, Callable, Sequence
from contextlib import asynccontextmanager
from pathlib import Path
from threading import Event, Thread
from typing import Any

import anyio
from starlette.applications import Starlette
from starlette.middleware import Middleware
from starlette.middleware.gzip import GZipMiddleware
from starlette.requests import ClientDisconnect, Request
from starlette.responses import FileResponse, JSONResponse, Response
from starlette.routing import Mount, Route
from starlette.staticfiles import StaticFiles

from rockflex._errors import InputError, SolverError
from rockflex._json import as_json_value
from rockflex.solve import RunStoppedError, stopping_when
from rockflex.web._downloads import MEDIA_TYPES, animation_file, download_file, study_file
from rockflex.web._earthquake import PULSES, embedded_suite_names, record_view, suite_view
from rockflex.web._folders import FIELD, MAX_LIST_BYTES, read_record_folder, unpacked_record_files
from rockflex.web._forms import PRESETS, forms_of_structures
from rockflex.web._jobs import MAX_FILES, MAX_STUDIES, BackgroundFileJob, BackgroundJobs, StudyJob
from rockflex.web._limits import (
    MAX_DURATION,
    MAX_ELEMENTS,
    MAX_FILE_BYTES,
    MAX_FOLDER_BYTES,
    MAX_FOLDER_FILES,
    MAX_FREEDOMS,
    MAX_MODELS,
    MAX_STUDY_RUNS,
)
from rockflex.web._protection import KnownHosts, SecurityHeaders
from rockflex.web._refusal import Refusal
from rockflex.web._requests import (
    file_download_answer,
    sampling_step_in_query,
    state_and_request_content,
    state_in_request,
    uploaded_file_bytes,
)
from rockflex.web._response import response_view
from rockflex.web._selection import scale_factor_view, selection_view
from rockflex.web._state import PageState, limit_state_labels, measure_labels
from rockflex.web._structure import build_page_structure, structure_view
from rockflex.web._studies import PAGES, study_plan
from rockflex.web._uploads import UploadedRecords, read_uploaded_matrices, read_uploaded_record, read_uploaded_vertical

WATCH_INTERVAL = 0.2  # s between checks whether a visitor still waits
STATIC = Path(__file__).parent / "static"
MAX_ANSWERS = 4  # answers computed at once: the engine releases the lock, and short answers must not wait for long ones
MAX_FILES_WRITTEN = 2  # files written at once: they take long and mostly hold the lock
MAX_FOLDERS_READ = 1  # folders read at once: each may need some hundred megabytes
MAX_FOLDERS_RECEIVED = 3  # folders in memory that are received, or wait to be read: each may have 80 MB
MAX_SELECTIONS_COMPUTED = 1  # selections at once: each may take some seconds
MAX_MESSAGE_LETTERS = 1000  # of a message: some repeat an input
Answer = Callable[[], Any]


class PageServer:
    """The requests of the page; only uploads and running studies are stored."""

    def __init__(self) -> None:
        self.uploads = UploadedRecords()
        self.jobs, self.files = (
            BackgroundJobs[StudyJob]("studies", MAX_STUDIES),
            BackgroundJobs[BackgroundFileJob]("files", MAX_FILES),
        )
        self._ready = Event()
        self._folders_received = asyncio.Semaphore(MAX_FOLDERS_RECEIVED)
        self._limiters: dict[int, anyio.CapacityLimiter] = {}

    def warm_up(self) -> None:
        """Import the modules and prepare the engine before the first visitor needs them."""
        pulse = {"source": "pulse", "pulse": {"shape": "one_sine", "amplitude": 5.0, "period": 0.5}}
        content = {"structure": PRESETS[0]["structure"], "record": pulse, "free_vibration": 0.0}
        state = PageState.model_validate(content | {"models": ["MDOF-S", "2DOF-S", "2DOF-C", "fixed"]})
        response_view(state, self.uploads)
        self._ready.set()

    async def answer(self, work: Answer, most: int = MAX_ANSWERS) -> Any:
        """Compute outside the event loop, with a limited number of answers at once."""
        if most not in self._limiters:
            self._limiters[most] = anyio.CapacityLimiter(most)
        return await anyio.to_thread.run_sync(work, limiter=self._limiters[most], abandon_on_cancel=True)

    async def run(self, request: Request, work: Answer, most: int = MAX_ANSWERS) -> Any:
        """Compute as `answer` does, and stop its runs when the visitor no longer waits for them."""
        gone = Event()

        def guarded() -> Any:
            with stopping_when(gone.is_set):
                return work()

        async def watch() -> None:
            while not await request.is_disconnected():
                await anyio.sleep(WATCH_INTERVAL)
            gone.set()

        watching = asyncio.create_task(watch())
        try:
            return await self.answer(guarded, most)
        except RunStoppedError as error:
            raise Refusal("The run was stopped because nobody waits for its answer.", 499) from error
        finally:
            watching.cancel()

    async def about(self, _: Request) -> Response:
        """Forms, presets, suites, pulses and limits, and whether the first answer is ready."""
        return JSONResponse(await anyio.to_thread.run_sync(_answer_about_page) | {"ready": self._ready.is_set()})

    async def suite(self, request: Request) -> Response:
        """Records of a suite."""
        name = request.path_params["name"]
        return JSONResponse(await anyio.to_thread.run_sync(suite_view, name))

    async def state(self, request: Request) -> Response:
        """Check the state of a link, and fill in its missing values."""
        state = await state_in_request(request)
        return JSONResponse(as_json_value(state.model_dump(exclude_none=True)))

    async def structure(self, request: Request) -> Response:
        """Structure tab."""
        state = await state_in_request(request)
        return JSONResponse(await self.answer(lambda: structure_view(state.structure, state.ground)))

    async def record(self, request: Request) -> Response:
        """Earthquake tab."""
        state = await state_in_request(request)

        def work() -> Any:
            try:
                built = build_page_structure(state.structure)
            except Refusal:
                built = None  # the record can be shown before the structure is complete
            return record_view(state, built, self.uploads)

        return JSONResponse(await self.answer(work))

    async def response(self, request: Request) -> Response:
        """Response tab."""
        state, content = await state_and_request_content(request)
        asked = content.get("focus"), content.get("element")
        return JSONResponse(await self.run(request, lambda: response_view(state, self.uploads, *asked)))

    async def upload(self, request: Request) -> Response:
        """A record from an uploaded file, or the vertical component of the record `under`; its name is in the query."""
        body, query = await uploaded_file_bytes(request), request.query_params
        name, units = query.get("name", "record"), query.get("units") or None
        dt, under = sampling_step_in_query(query.get("dt", "")), query.get("under", "")

        def work() -> Any:
            if under:
                motion = read_uploaded_vertical(name, body, units, dt, self.uploads.get(under))
            else:
                motion = read_uploaded_record(name, body, units, dt)
            key = self.uploads.add(motion, body, f"{units} {dt} {motion.name} {under}")
            facts = {"samples": motion.acceleration.size, "pga": motion.pga, "pva": motion.pva}
            return as_json_value({"upload": key, "name": motion.name, **facts})

        return JSONResponse(await self.answer(work))

    async def folder(self, request: Request) -> Response:
        """Records from a folder."""
        async with self._folders_received:  # others wait with their files on their own machines
            body, query = (
                await uploaded_file_bytes(request, MAX_FOLDER_BYTES + MAX_LIST_BYTES, MAX_FOLDER_BYTES),
                request.query_params,
            )
            units, dt = query.get("units") or None, sampling_step_in_query(query.get("dt", ""), FIELD)

            def work() -> dict[str, Any]:
                files = unpacked_record_files(body)
                folder = read_record_folder(files, units, dt)
                token = self.uploads.folders.add(folder, files, f"{units} {dt}")
                return {"folder": token, **folder.report}

            return JSONResponse(await self.answer(work, MAX_FOLDERS_READ))

    async def folder_report(self, request: Request) -> Response:
        """Report on a folder that the server has."""
        token = request.path_params["token"]
        return JSONResponse({"folder": token, **self.uploads.folders.get(token).report})

    async def selection(self, request: Request) -> Response:
        """Records selected for a target spectrum."""
        state = await state_in_request(request)
        return JSONResponse(
            await self.run(request, lambda: selection_view(state, self.uploads), MAX_SELECTIONS_COMPUTED)
        )

    async def factor(self, request: Request) -> Response:
        """Scale factor of the record for a target spectrum."""
        state, content = await state_and_request_content(request)
        return JSONResponse(
            await self.run(request, lambda: scale_factor_view(state, self.uploads, content.get("period")))
        )

    async def matrices(self, request: Request) -> Response:
        """Matrices from a file."""
        body, query = await uploaded_file_bytes(request), request.query_params
        name, part = query.get("name", "matrices"), query.get("part", "")
        return JSONResponse(await self.answer(lambda: read_uploaded_matrices(name, body, part)))

    async def download(self, request: Request) -> Response:
        """A file of the results on the page."""
        state = await state_in_request(request)
        what = request.path_params["what"]
        return file_download_answer(
            *await self.run(request, lambda: download_file(state, what, self.uploads), MAX_FILES_WRITTEN)
        )

    async def start(self, request: Request) -> Response:
        """Start a study."""
        kind = _study_kind_in_request(request)
        state = await state_in_request(request)

        def work() -> dict[str, str]:
            return {"token": self.jobs.start(StudyJob(study_plan(PAGES[kind].study(state, self.uploads), kind), kind))}

        return JSONResponse(await self.answer(work))

    async def progress(self, request: Request) -> Response:
        """Progress of a study, and its results so far for the limit states of the page."""
        kind, job = self._job(request)
        state = await state_in_request(request)
        return JSONResponse(await self.answer(lambda: PAGES[kind].view(job, state)))

    async def study_file(self, request: Request) -> Response:
        """Table or figure of a study."""
        kind, job = self._job(request)
        state = await state_in_request(request)
        what = request.path_params["what"]
        return file_download_answer(
            *await self.answer(lambda: study_file(PAGES[kind], job, state, what), MAX_FILES_WRITTEN)
        )

    async def cancel(self, request: Request) -> Response:
        """Stop a study."""
        self.jobs.cancel(request.path_params["token"])
        return JSONResponse({})

    async def make(self, request: Request) -> Response:
        """Start to make a file that takes long."""
        what = request.path_params["what"]
        if what != "animation":
            raise Refusal(f"There is no file named {what[:40]!r} to make.", 404)
        state = await state_in_request(request)
        return JSONResponse(
            {"token": self.files.start(BackgroundFileJob(lambda told: animation_file(state, self.uploads, told)))}
        )

    async def making(self, request: Request) -> Response:
        """Progress of a file."""
        job = self.files.get(request.path_params["token"])
        errors = job.errors or ({"": job.message} if job.message else {})
        return JSONResponse({"status": job.status, "done": job.done, "total": job.total, "errors": errors})

    async def made(self, request: Request) -> Response:
        """Hand out a file that was made."""
        job = self.files.get(request.path_params["token"])
        if job.file is None:
            raise Refusal("The file is not finished.", 404)
        name, content = job.file
        return file_download_answer(name, MEDIA_TYPES[Path(name).suffix], content)

    async def unmake(self, request: Request) -> Response:
        """Stop to make a file."""
        self.files.cancel(request.path_params["token"])
        return JSONResponse({})

    def _job(self, request: Request) -> tuple[str, StudyJob]:
        kind, job = _study_kind_in_request(request), self.jobs.get(request.path_params["token"])
        if job.kind != kind:
            raise Refusal(f"That study is not a {kind} study.", 404)
        return kind, job


def _study_kind_in_request(request: Request) -> str:
    kind = request.path_params["kind"]
    if kind not in PAGES:
        raise Refusal(f"There is no study of the kind {kind[:40]!r}.", 404)
    return kind


def create_page_application(host: str, names: Sequence[str]) -> Starlette:
    """Return the application for a host name; it answers to that and to some others (`KnownHosts`)."""
    server = PageServer()

    @asynccontextmanager
    async def lifespan(_: Starlette) -> AsyncGenerator[None]:
        Thread(target=server.warm_up, name="warm-up", daemon=True).start()
        yield
        server.jobs.close()
        server.files.close()

    middleware = [
        Middleware(SecurityHeaders),
        Middleware(KnownHosts, host=host, names=names),
        Middleware(GZipMiddleware, minimum_size=1000, compresslevel=3),
    ]
    routes = [
        Route("/", _page_html),
        Route("/api/about", server.about),
        Route("/api/suite/{name}", server.suite),
        Route("/api/state", server.state, methods=["POST"]),
        Route("/api/structure", server.structure, methods=["POST"]),
        Route("/api/record", server.record, methods=["POST"]),
        Route("/api/response", server.response, methods=["POST"]),
        Route("/api/upload", server.upload, methods=["POST"]),
        Route("/api/folder", server.folder, methods=["POST"]),
        Route("/api/folder/{token}", server.folder_report),
        Route("/api/selection", server.selection, methods=["POST"]),
        Route("/api/factor", server.factor, methods=["POST"]),
        Route("/api/matrices", server.matrices, methods=["POST"]),
        Route("/api/download/{what}", server.download, methods=["POST"]),
        Route("/api/study/{kind}", server.start, methods=["POST"]),
        Route("/api/study/{kind}/{token}", server.progress, methods=["POST"]),
        Route("/api/study/{kind}/{token}/{what}", server.study_file, methods=["POST"]),
        Route("/api/job/{token}", server.cancel, methods=["DELETE"]),
        Route("/api/file/{what}", server.make, methods=["POST"]),
        Route("/api/file/{token}", server.making),
        Route("/api/file/{token}", server.unmake, methods=["DELETE"]),
        Route("/api/file/{token}/content", server.made),
        Mount("/static", StaticFiles(directory=STATIC)),
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


def _answer_about_page() -> dict[str, Any]:
    usual = ("amplitude", "period")
    pulses = {name: {"title": each.title, "fields": (*usual, *each.fields)} for name, each in PULSES.items()}
    limits = {
        "file": MAX_FILE_BYTES,
        "files": MAX_FOLDER_FILES,
        "folder": MAX_FOLDER_BYTES,
        "freedoms": MAX_FREEDOMS,
        "duration": MAX_DURATION,
        "models": MAX_MODELS,
        "runs": MAX_STUDY_RUNS,
        "elements": MAX_ELEMENTS,
    }
    first = PageState.model_validate({"structure": PRESETS[0]["structure"]})
    return forms_of_structures() | {
        "suites": embedded_suite_names(),
        "measures": measure_labels(),
        "limit_states": limit_state_labels(),
        "pulses": pulses,
        "limits": limits,
        "state": as_json_value(first.model_dump(exclude_none=True)),
    }


async def _answer_to_refusal(_: Request, error: Exception) -> Response:
    assert isinstance(error, Refusal)
    errors = {path[:200]: text[:MAX_MESSAGE_LETTERS] for path, text in error.errors.items()}
    return JSONResponse({"errors": errors}, status_code=error.status)


async def _answer_to_unusable_input(_: Request, error: Exception) -> Response:
    return JSONResponse({"errors": {"": str(error)[:MAX_MESSAGE_LETTERS]}}, status_code=422)


async def _answer_to_gone_client(_: Request, __: Exception) -> Response:
    return Response(status_code=400)  # the visitor left during the request, and nobody reads this


async def _answer_to_failure(_: Request, error: Exception) -> Response:
    logging.getLogger(__name__).error("Internal error", exc_info=error)
    message = "An internal error occurred; the log of the server has the details."
    return JSONResponse({"errors": {"": message}}, status_code=500)

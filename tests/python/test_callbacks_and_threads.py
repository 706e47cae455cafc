"""Progress, cancelling, the log, Ctrl-C, and other threads while the library works."""

from __future__ import annotations

import _thread
import copy
import gc
import pickle
import signal
import subprocess
import sys
import threading
import time
import weakref
from collections.abc import Callable, Iterator

import numpy as np
import pytest

import lightband

PATIENCE = 30.0  # seconds after which a thread that has not ended counts as stuck


@pytest.fixture
def long_frame(context: lightband.Context) -> lightband.Frame:
    """A frame that takes a good part of a second and reports progress on the way."""
    return context.frame(64, 64, samples=64, accumulate=64, method="reference")


def run_to_the_end(work: Callable[[], object]) -> None:
    """Runs work in a thread; fails where it hangs."""
    failures: list[BaseException] = []

    def guarded() -> None:
        try:
            work()
        except BaseException as failure:
            failures.append(failure)

    thread = threading.Thread(target=guarded, daemon=True)
    thread.start()
    thread.join(PATIENCE)
    assert not thread.is_alive(), "stuck: probably two threads wait for each other"
    if failures:
        raise failures[0]


WORK: dict[str, dict[str, float | str]] = {
    "samples": {"samples": 256},
    "rounds": {"target_error": 0.02},
    "time": {"time_budget": 300},
    "reference": {"method": "reference", "samples": 512},
    "accumulate": {"samples": 32, "accumulate": 8},
}


@pytest.mark.parametrize("settings", WORK.values(), ids=WORK)
def test_progress_rises_evenly_from_0_to_1(
    context: lightband.Context, scene: lightband.Scene, settings: dict[str, float | str]
) -> None:
    """The fraction is that of time; how near it comes depends on what else the machine does, that it never stands still does not."""
    frame = context.frame(160, 160, **settings)
    frame.render(scene)  # makes the tables and measures the device
    fractions: list[float] = []
    times: list[float] = []

    def note(fraction: float) -> None:
        fractions.append(fraction)
        times.append(time.perf_counter())

    frame.render(scene, progress=note)
    assert all(type(fraction) is float for fraction in fractions)
    assert fractions[0] == 0 and fractions[-1] == 1 and len(fractions) >= 5
    assert all(early < late for early, late in zip(fractions, fractions[1:]))
    elapsed = (np.array(times) - times[0]) / (times[-1] - times[0])
    assert all(fraction < 0.9 for fraction, passed in zip(fractions, elapsed) if passed < 0.1)


def test_progress_runs_on_the_calling_thread(long_frame: lightband.Frame, scene: lightband.Scene) -> None:
    threads: set[int] = set()
    long_frame.render(scene, progress=lambda _: threads.add(threading.get_ident()))
    assert threads == {threading.get_ident()}


def test_cancel_cancels(long_frame: lightband.Frame, scene: lightband.Scene) -> None:
    long_frame.render(scene)
    before = long_frame.color
    long_frame["seed"] = 1
    calls = 0

    def stop(_: float) -> object:
        nonlocal calls
        calls += 1
        return lightband.CANCEL

    with pytest.raises(lightband.Cancelled):
        long_frame.render(scene, progress=stop)
    assert calls == 1
    np.testing.assert_array_equal(long_frame.color, before)


ANSWERS = [None, False, True, 0, 7, "", "cancel", "lightband.CANCEL", np.True_, np.zeros(2), lightband.Cancelled, object()]


@pytest.mark.parametrize("answer", ANSWERS, ids=lambda answer: "an object" if type(answer) is object else repr(answer))
def test_any_other_answer_goes_on(context: lightband.Context, scene: lightband.Scene, answer: object) -> None:
    """As of a progress bar, whose update says whether it has drawn itself."""
    frame = context.frame(8, 8, samples=4)
    frame.render(scene, progress=lambda _: answer)
    assert frame.stats.covered_pixels > 0


def test_cancel_is_one_object_with_a_name() -> None:
    for again in (copy.copy(lightband.CANCEL), copy.deepcopy(lightband.CANCEL)):
        assert again is lightband.CANCEL
    for protocol in range(pickle.HIGHEST_PROTOCOL + 1):
        assert pickle.loads(pickle.dumps(lightband.CANCEL, protocol)) is lightband.CANCEL
    assert repr(lightband.CANCEL) == "lightband.CANCEL"


class Mishap(Exception):
    pass


def test_an_exception_of_the_callback_comes_back_itself(long_frame: lightband.Frame, scene: lightband.Scene) -> None:
    mishap = Mishap("of the callback")

    def fail(_: float) -> None:
        raise mishap

    with pytest.raises(Mishap) as caught:
        long_frame.render(scene, progress=fail)
    assert caught.value is mishap
    with pytest.raises(lightband.StateError):
        long_frame.color
    long_frame.render(scene)


@pytest.fixture
def ctrl_c_heard() -> Iterator[None]:
    """Python's own handler of Ctrl-C: a shell's background jobs start with the signal ignored."""
    former = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, former)


@pytest.mark.usefixtures("ctrl_c_heard")
def test_ctrl_c_without_a_callback(long_frame: lightband.Frame, scene: lightband.Scene) -> None:
    long_frame["accumulate"] = 1 << 15  # about half a minute, were it not interrupted
    timer = threading.Timer(0.3, _thread.interrupt_main)
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        long_frame.render(scene)
    timer.join()
    with pytest.raises(lightband.StateError):  # interrupted, not rendered to the end
        long_frame.color
    long_frame["accumulate"] = 1
    long_frame.render(scene)


def test_other_threads_run_while_a_frame_renders(long_frame: lightband.Frame, scene: lightband.Scene) -> None:
    """Python is told never to switch threads of its own accord: the other one runs only where the library lets it."""
    count, done = 0, threading.Event()

    def run() -> None:
        nonlocal count
        while not done.is_set():
            count += 1
            time.sleep(0.0005)

    seen: list[int] = []
    interval = sys.getswitchinterval()
    sys.setswitchinterval(1000)
    thread = threading.Thread(target=run)
    try:
        thread.start()
        long_frame.render(scene, progress=lambda _: seen.append(count))
    finally:
        sys.setswitchinterval(interval)
        done.set()
        thread.join()
    assert seen[-1] - seen[0] >= 10


@pytest.mark.parametrize(
    "work",
    [
        lambda context, mesh: mesh.stats,
        lambda context, mesh: context.builtin_mesh("plane", 8),
        lambda context, mesh: mesh.close(),
        lambda context, mesh: None,
    ],
    ids=["ask", "make", "close", "collect"],
)
def test_a_thread_that_needs_the_context_during_a_render_waits(
    context: lightband.Context,
    long_frame: lightband.Frame,
    scene: lightband.Scene,
    work: Callable[[lightband.Context, lightband.Mesh], object],
) -> None:
    """Were the interpreter held inside the library, this thread and the callback would wait for each other."""
    started = threading.Event()
    meshes = [context.builtin_mesh("plane", 8)]

    def need() -> None:
        started.wait(PATIENCE)
        work(context, meshes.pop())  # and drops the last reference

    def report(_: float) -> None:
        started.set()
        time.sleep(0.002)

    needing = threading.Thread(target=need, daemon=True)
    needing.start()
    run_to_the_end(lambda: long_frame.render(scene, progress=report))
    needing.join(PATIENCE)
    assert not needing.is_alive() and not meshes


def test_two_contexts_render_at_once(scene: lightband.Scene, context: lightband.Context) -> None:
    with lightband.Context(device="software", cache_path="") as other:
        second = other.scene()
        second.add(other.builtin_mesh("sphere", 32), other.lambert(0.5))
        second.environment = other.environment(scene.environment.radiance)
        second.camera((0, 0, 3), (0, 0, 0))
        frames = [(context.frame(32, 32, samples=16), scene), (other.frame(32, 32, samples=16), second)]
        threads = [threading.Thread(target=frame.render, args=(what,)) for frame, what in frames]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join(PATIENCE)
        np.testing.assert_array_equal(frames[0][0].color, frames[1][0].color)


@pytest.mark.parametrize(
    "call",
    [
        lambda context, frame, scene: frame.stats,
        lambda context, frame, scene: frame.color,
        lambda context, frame, scene: frame.render(scene),
        lambda context, frame, scene: context.lambert(0.5),
        lambda context, frame, scene: lightband.Context(device="software"),
        lambda context, frame, scene: frame.__setitem__("samples", 3),
        lambda context, frame, scene: scene.add(None, None) if False else scene.set_transform(0, np.eye(4)),
    ],
    ids=["stats", "color", "render", "lambert", "Context", "setting", "set_transform"],
)
def test_a_callback_must_not_call_the_library(
    context: lightband.Context,
    long_frame: lightband.Frame,
    scene: lightband.Scene,
    call: Callable[[lightband.Context, lightband.Frame, lightband.Scene], object],
) -> None:
    refused = 0

    def report(_: float) -> None:
        nonlocal refused
        with pytest.raises(lightband.StateError, match="callback"):
            call(context, long_frame, scene)
        refused += 1

    run_to_the_end(lambda: long_frame.render(scene, progress=report))
    assert refused >= 3


def test_objects_may_die_in_a_callback(
    context: lightband.Context, long_frame: lightband.Frame, scene: lightband.Scene
) -> None:
    objects: list[object] = [context.builtin_mesh("plane", 8) for _ in range(4)]
    objects += [context.lambert(0.1), context.frame(4, 4), context.environment(np.ones((2, 4, 3)))]
    kept = context.lambert(0.2)

    def report(_: float) -> None:
        if objects:
            objects.pop()
        kept.close()

    run_to_the_end(lambda: long_frame.render(scene, progress=report))
    with pytest.raises(lightband.InvalidHandle):
        kept.albedo(0)


class Holder:
    """Holds itself, so that only the garbage collector frees it."""

    def __init__(self, held: object) -> None:
        self.held = held
        self.itself = self


def test_the_collector_may_free_objects_in_a_callback(
    context: lightband.Context,
    long_frame: lightband.Frame,
    scene: lightband.Scene,
    unraisable: list[BaseException | None],
    capfd: pytest.CaptureFixture[str],
) -> None:
    """They are released when the render call is over: inside a callback the library would refuse it."""
    made: list[weakref.ref[Holder]] = []

    def report(_: float) -> None:
        if len(made) < 40:
            return
        gc.collect()
        assert all(reference() is None for reference in made)

    gc.disable()
    try:
        for _ in range(20):
            holders = Holder(context.frame(64, 64)), Holder(context.builtin_mesh("sphere", 16))
            made += map(weakref.ref, holders)
            del holders
        run_to_the_end(lambda: long_frame.render(scene, progress=report))
    finally:
        gc.enable()
    assert long_frame.stats.covered_pixels > 0
    assert not unraisable and capfd.readouterr() == ("", "")


def test_an_array_may_die_in_a_callback(long_frame: lightband.Frame, scene: lightband.Scene) -> None:
    long_frame.render(scene)
    arrays = [long_frame.color]
    run_to_the_end(lambda: long_frame.render(scene, progress=lambda _: arrays.clear()))


@pytest.fixture
def unraisable(monkeypatch: pytest.MonkeyPatch) -> Iterator[list[BaseException | None]]:
    heard: list[BaseException | None] = []
    monkeypatch.setattr("sys.unraisablehook", lambda unraised: heard.append(unraised.exc_value))
    yield heard


def test_the_log_hears_the_library() -> None:
    heard: list[str] = []
    with lightband.Context(device="software", cache_path="", log=heard.append) as context:
        context.lambert(0.5)
        assert any(context.device_name in message for message in heard)
    assert all(type(message) is str for message in heard)


def test_the_log_lives_as_long_as_what_may_call_it() -> None:
    heard: list[str] = []
    context = lightband.Context(device="software", cache_path="", log=lambda message: heard.append(message))
    mesh = context.builtin_mesh("plane", 8)
    del context
    gc.collect()
    assert mesh.stats.triangles > 0
    del mesh
    gc.collect()


class Viewer:
    """Keeps what makes returns of its context, whose log is a method of its own."""

    def __init__(self, keep: Callable[[lightband.Context], object]) -> None:
        self.lines: list[str] = []
        self.kept = keep(lightband.Context(device="software", cache_path="", log=self.hear))

    def hear(self, line: str) -> None:
        self.lines.append(line)


class Window(lightband.Context):
    """Is the context that its log belongs to."""

    def __init__(self) -> None:
        super().__init__("software", "", self.hear)

    def hear(self, line: str) -> None:
        pass


def scene_in(context: lightband.Context) -> lightband.Scene:
    scene = context.scene()
    scene.environment = context.environment(np.ones((2, 4, 3)))
    return scene


KEPT: dict[str, Callable[[], object]] = {
    "Context": lambda: Viewer(lambda context: context),
    "Brdf": lambda: Viewer(lambda context: context.lambert(0.5)),
    "Environment": lambda: Viewer(lambda context: context.environment(np.ones((2, 4, 3)))),
    "Mesh": lambda: Viewer(lambda context: context.builtin_mesh("plane", 8)),
    "Scene": lambda: Viewer(scene_in),
    "environment of a scene": lambda: Viewer(lambda context: scene_in(context).environment),
    "Frame": lambda: Viewer(lambda context: context.frame(4, 4)),
    "settings": lambda: Viewer(lambda context: context.frame(4, 4).settings),
    "array": lambda: Viewer(lambda context: context.environment(np.ones((2, 4, 3))).radiance),
    "subclass": Window,
}


@pytest.mark.parametrize("make", KEPT.values(), ids=KEPT)
def test_a_log_of_the_holder_keeps_nothing_alive(make: Callable[[], object], unraisable: list[object]) -> None:
    seen = weakref.ref(make())
    gc.collect()
    assert seen() is None
    assert not unraisable


def test_what_lost_its_log_is_silent() -> None:
    viewer = Viewer(lambda context: context)
    seen, mesh = weakref.ref(viewer), viewer.kept.builtin_mesh("plane", 8)  # type: ignore[attr-defined]
    del viewer
    gc.collect()
    assert seen() is not None, "the mesh may still speak to it"
    del mesh
    gc.collect()
    assert seen() is None


def test_a_log_without_weak_references_is_heard() -> None:
    class Slotted:
        __slots__ = ("lines",)

        def __init__(self) -> None:
            self.lines: list[str] = []

        def __call__(self, line: str) -> None:
            self.lines.append(line)

    log = Slotted()
    lightband.Context(device="software", cache_path="", log=log).close()
    assert log.lines


ENDING = """
import sys, threading, time
import lightband

class SlowToDie:
    def __del__(self, sleep=time.sleep):
        sleep(0.5)

context = lightband.Context(device="software", cache_path="")
scene = context.scene()
scene.environment = context.environment([[[1, 1, 1]] * 8] * 4)
scene.camera(eye=(0, 0, 2), target=(0, 0, 0))
scene.add(context.builtin_mesh("sphere", 16), context.lambert(0.5))
inside = threading.Event()

def render():
    frame = context.frame(16, 16, samples=16)
    while True:
        frame.render(scene)
        inside.set()

def progress():
    frame = context.frame(16, 16, samples=16)
    while True:
        frame.render(scene, lambda done: inside.set())

def log():
    while True:
        lightband.Context(device="software", cache_path="", log=lambda message: inside.set())

def small_calls():
    while True:
        context.lambert(0.5).albedo(0)
        inside.set()

threading.Thread(target=globals()[sys.argv[1]], daemon=True).start()
inside.wait()
time.sleep(0.1)
late = SlowToDie()
sys.exit(7)
"""


@pytest.mark.parametrize("work", ["render", "progress", "log", "small_calls"])
def test_a_process_ends_while_a_thread_is_inside(work: str) -> None:
    """With its own status: Python unwinds such a thread, and C++ aborts where a noexcept function is unwound."""
    outcome = subprocess.run([sys.executable, "-c", ENDING, work], capture_output=True, text=True, timeout=PATIENCE)
    assert (outcome.returncode, outcome.stdout, outcome.stderr) == (7, "", "")


def test_an_exception_of_the_log_is_unraisable(unraisable: list[BaseException | None]) -> None:
    mishap = Mishap("of the log")

    def fail(_: str) -> None:
        raise mishap

    lightband.Context(device="software", cache_path="", log=fail).close()
    assert unraisable and set(unraisable) == {mishap}


def test_silence_without_a_log(
    capfd: pytest.CaptureFixture[str], long_frame: lightband.Frame, scene: lightband.Scene
) -> None:
    lightband.Context(device="software", cache_path="").close()
    long_frame.render(scene)
    assert capfd.readouterr() == ("", "")

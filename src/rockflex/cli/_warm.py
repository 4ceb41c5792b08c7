"""``rockflex warm``: compilation ahead of need."""

EPILOG = """[bold]Examples[/bold]

rockflex warm

NUMBA_CACHE_DIR=/var/cache/rockflex rockflex warm"""


def warm() -> None:
    """Compile all kernels now, so that the first run does not wait for them; does nothing if they are compiled.

    They are kept for later processes, until rockflex or numba is upgraded.
    """
    from rockflex._shown import counted
    from rockflex.cli._console import note, steps
    from rockflex.progress import duration
    from rockflex.study import warm as start

    with steps("Compiling the kernels for") as show:
        done = start(show)
    if done.folder is None:
        note("The compiled kernels cannot be kept, because no folder can be written. Set NUMBA_CACHE_DIR to one.")
    elif done.compiled == 0:
        note(f"All kernels are compiled already, under {done.folder}.")
    else:
        note(f"{counted(done.compiled, 'kernel')} compiled in {duration(done.duration)}, kept under {done.folder}.")

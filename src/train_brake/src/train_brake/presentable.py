"""Text of unknown origin (names, paths, what programs report), as it may be shown on a terminal and on a page; what
becomes of the output when a command ends."""

import contextlib
import os
import sys
import unicodedata
from typing import Callable, List, NoReturn

TURNS_WRITING = {*range(0x202A, 0x202F), *range(0x2066, 0x206A)}  # to the left, to the right


def presentable(text: object) -> str:
    """Each control character but line feeds and tabs becomes "?", and so do those that turn the direction of writing,
    and bytes of a file's name that are not UTF-8. The same as train_console::Presentable."""
    return "".join(
        "?" if (unicodedata.category(c) in ("Cc", "Cs") and c not in "\n\t") or ord(c) in TURNS_WRITING else c
        for c in (os.fspath(text) if isinstance(text, os.PathLike) else str(text))
    )


def accept_all_characters() -> None:
    """In any locale, a character that the output's encoding lacks is written as an escape, without an error."""
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="backslashreplace")


def tell(line: str) -> None:
    """Prints information that is not essential, such as where the results are. A failing output (a full disk, a closed
    pipe) is not an error: neither now nor when Python flushes its buffer at the end of the program.
    """
    try:
        print(presentable(line), flush=True)
    except OSError:
        with contextlib.suppress(OSError):  # closed
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def exit_with(name: str, main: Callable[[List[str]], int]) -> NoReturn:
    """Runs the command and ends the program with its exit code: 1 in place of 0 if what it printed last could not be
    written (a full disk, a closed pipe). Python itself finds that after it has decided on the code, and ends with 120.
    """
    try:
        code = main(sys.argv[1:])
    except SystemExit as end:  # of --help and wrong arguments
        code = end.code
    try:
        if sys.stdout is not None:  # closed
            sys.stdout.flush()
    except OSError as error:
        with contextlib.suppress(OSError):
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        with contextlib.suppress(OSError):
            if not isinstance(error, BrokenPipeError):  # nobody reads on
                print(f"{name}: the output could not be written: {error.strerror}", file=sys.stderr, flush=True)
        code = code or 1
    sys.exit(code)

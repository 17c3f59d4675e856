"""Text of unknown origin (names, paths, what programs report), as it may be shown on a terminal and on a page."""

import contextlib
import os
import sys
import unicodedata

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

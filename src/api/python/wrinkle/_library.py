"""The C library and its table of commands."""

from __future__ import annotations

import glob
import json
import os
import re
from typing import Any

import cffi

_here = os.path.dirname(os.path.abspath(__file__))
ffi = cffi.FFI()


def _declarations() -> str:
    """The declarations of wrinkle.h without its preprocessor lines and comments."""
    for folder in (_here, os.path.join(_here, "..", "..")):
        path = os.path.join(folder, "wrinkle.h")
        if os.path.exists(path):
            break
    with open(path, encoding="utf-8") as file:
        text = re.sub(r"/\*.*?\*/", "", file.read(), flags=re.S)
    text = re.sub(r"#ifdef __cplusplus.*?#endif", "", text, flags=re.S)
    text = re.sub(r"^#.*$", "", text, flags=re.M)
    return text.replace("WR_PUBLIC ", "")


def _load() -> Any:
    """The library: $WRINKLE_LIBRARY, the one of this installation, else the system's."""
    given = os.environ.get("WRINKLE_LIBRARY")
    if given:
        return ffi.dlopen(given)
    prefix = os.path.join(_here, "..", "..", "..", "..")
    for pattern in ("lib/libwrinkle.so.0", "lib/*/libwrinkle.so.0"):
        for path in glob.glob(os.path.join(prefix, pattern)):
            return ffi.dlopen(path)
    return ffi.dlopen("libwrinkle.so.0")


ffi.cdef(_declarations())
lib = _load()


def _table() -> dict:
    text = lib.wr_doc_commands_json()
    try:
        return json.loads(ffi.string(text).decode())
    finally:
        lib.wr_doc_free_text(text)


commands: dict = {command["name"]: command for command in _table()["commands"]}
"""The table of commands: name, help, arguments with ranges and defaults."""

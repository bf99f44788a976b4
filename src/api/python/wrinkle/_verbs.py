"""The commands as methods: command lines from Python's values, and docstrings from the table of commands."""

from __future__ import annotations

import os
import re
from typing import Any, Callable, Optional, Sequence

import numpy as np

from ._library import commands



def _quoted(text: str) -> str:
    if text and not re.search(r"[\s\"\\#';]", text):
        return text
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n") + '"'


def _number(value: Any) -> str:
    if isinstance(value, (bool, np.bool_)):
        return "on" if value else "off"
    if isinstance(value, (int, np.integer)):
        return str(int(value))
    return repr(float(value))


def _word(spec: dict, value: Any) -> str:
    """A value as the text of an argument: sizes 3x2, tuples 1,2, lists 1,2;3,4."""
    if isinstance(value, os.PathLike):
        value = os.fspath(value)
    if isinstance(value, str):
        return _quoted(value)
    if isinstance(value, np.ndarray):
        value = value.tolist()
    if not isinstance(value, (list, tuple)):
        return _number(value)
    if any(isinstance(item, (list, tuple, np.ndarray)) for item in value) or spec["type"] == "list":
        rows = (row if isinstance(row, (list, tuple, np.ndarray)) else (row,) for row in value)
        return ";".join(",".join(_number(x) for x in row) for row in rows)
    shape = spec.get("shape", "")
    if all(isinstance(item, str) for item in value):
        return _quoted((";" if ";" in shape else ",").join(value))
    by = "x" if spec["type"] == "size" or re.match(r"(MxN|WIDTHxHEIGHT)", shape) else ","
    return by.join(_number(x) for x in value)


def _specs(name: str, form: Optional[str]) -> dict:
    """The arguments of a command by name; unknown forms and names are refused by the command itself, with the nearest word."""
    command = commands[name]
    forms = {f["name"]: f["args"] for f in command.get("forms", [])}
    return {spec["name"]: spec for spec in command["args"] + forms.get(form, [])}


def _named(specs: dict, values: dict) -> list[str]:
    """Words name=value; a name that Python keeps for itself has an underscore at its end: from_."""
    words = []
    for key, value in values.items():
        key = key.rstrip("_")
        if key not in specs and key.replace("_", "-") in specs:
            key = key.replace("_", "-")
        if value is not None:
            words.append(f"{key}={_word(specs.get(key, {'type': 'text'}), value)}")
    return words


def _line(name: str, places: Sequence[Any], named: dict) -> str:
    """The command line of a call: a form's name and positional values first, then name=value."""
    has_forms = bool(commands[name].get("forms"))
    form = str(places[0]) if has_forms and places else None
    specs = _specs(name, form)
    positional = [spec for spec in specs.values() if spec.get("positional")]
    words = [name] + ([form] if form else [])
    for i, value in enumerate(places[1:] if form else places):
        words.append(_word(positional[i] if i < len(positional) else {"type": "text"}, value))
    return " ".join(words + _named(specs, named))


def export_words(kind: str, options: dict) -> bytes:
    """The words of an export: its kind and its options."""
    return " ".join([kind] + _named(_specs("export", kind), options)).encode()


def _help(command: dict) -> str:
    """The docstring of a command's method."""

    def rows(args: list) -> list:
        lines = []
        for arg in args:
            extra = ""
            if arg.get("choices"):
                extra = "; one of " + ", ".join(arg["choices"])
            if arg.get("default") is not None:
                extra += f" (default {arg['default']})"
            lines.append(f"    {arg['name']}: {arg['help']}{extra}")
        return lines

    text = [command["help"], ""]
    if command.get("details"):
        text += [command["details"], ""]
    text += rows(command["args"])
    for form in command.get("forms", []):
        text += ["", f"  {form['name']}: {form.get('help') or ''}"] + rows(form["args"])
    if command.get("example"):
        text += ["", "Command line: " + command["example"]]
    return "\n".join(text)


def _method(name: str) -> Callable[..., None]:
    def method(self, *values, **named):
        self.run(_line(name, values, named))

    method.__name__ = method.__qualname__ = name.replace("-", "_")
    method.__doc__ = _help(commands[name])
    return method


class Verbs:
    """A method for each command."""

    def run(self, line: str) -> None:
        raise NotImplementedError


for _name in commands:
    setattr(Verbs, _name.replace("-", "_"), _method(_name))

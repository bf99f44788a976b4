"""Writes the types of the commands' methods, wrinkle/_verbs.pyi, to standard output: run it with the package on PYTHONPATH."""

import keyword
import textwrap

from wrinkle._library import commands

KINDS = {"number": "float", "size": "Sequence[int]", "tuple": "Sequence[float]", "list": "Any", "layer": "int | str",
         "path": "str | PathLike[str]"}


def literal(words):
    return f"Literal[{', '.join(repr(word) for word in words)}]"


def kind_of(arg):
    choices = arg.get("choices")
    if choices in (["off", "on"], ["on", "off"]):
        return "bool | str"
    if choices:
        return literal(choices)
    if arg["type"] == "size" and arg.get("components") == 1 or arg["type"] == "tuple" and arg.get("components") == 1:
        return "float"
    return KINDS.get(arg["type"], "Any" if arg["type"] == "text" else "str")


def arguments(command):
    """All arguments of a command, of each form: positional ones, then a type for each name."""
    places, named = [], {}
    for args in [command["args"]] + [form["args"] for form in command.get("forms", [])]:
        for arg in args:
            name = arg["name"].replace("-", "_")
            if keyword.iskeyword(name):
                name += "_"
            kind = kind_of(arg)
            if arg.get("positional"):
                places.append(kind)
            elif name not in named:
                named[name] = kind
            elif kind not in named[name].split(" | "):
                named[name] = "Any"
    return places, named


def method(command):
    places, named = arguments(command)
    head = ["self"]
    if command.get("forms"):
        head.append(f"_form: {literal(form['name'] for form in command['forms'])}")
        head.append("/")
        if places:
            head.append("*_values: Any")
    elif places:
        head.append("*_values: Any")
    if named and not places:
        head.append("*")
    head += [f"{name}: {kind} | None = ..." for name, kind in named.items()]
    lines = textwrap.wrap(", ".join(head), 112, break_long_words=False, break_on_hyphens=False)
    body = "\n".join("        " + line for line in lines)
    return (f"    def {command['name'].replace('-', '_')}(\n{body}\n    ) -> None:\n"
            f"        \"\"\"{command['help'][0].upper()}{command['help'][1:]}.\"\"\"\n")


print("# Written by make_stub.py from the table of commands.")
print("from os import PathLike\nfrom typing import Any, Literal, Sequence\n")
print("def export_words(kind: str, options: dict[str, Any]) -> bytes: ...\n")
print("class Verbs:\n    def run(self, line: str) -> None: ...\n")
print("\n".join(method(command) for command in commands.values()), end="")

# SPDX-License-Identifier: MIT
"""The public headers as Doxygen reads them: runs it, and gives its XML as plain objects with descriptions in HTML."""
import html
import pathlib
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from typing import NamedTuple

HERE = pathlib.Path(__file__).resolve().parent
TAGS = {"computeroutput": "code", "emphasis": "em", "bold": "strong", "itemizedlist": "ul", "orderedlist": "ol",
        "listitem": "li", "verbatim": "pre", "preformatted": "pre", "subscript": "sub", "superscript": "sup"}
SIGNS = {"ndash": "–", "mdash": "—", "nonbreakablespace": "\u00a0", "sp": " ", "linebreak": "<br>"}


class Item(NamedTuple):
    kind: str  # function, define, enum, struct, typedef
    name: str
    line: int
    signature: str  # C, as it is declared
    description: str  # HTML
    text: str  # the same without marks
    sections: dict  # HTML of each @par: Errors, Cost
    parameters: list  # (name, HTML): of a function those that are described, else members and values
    declared: list  # the names of a function's parameters
    returns: str


class Header(NamedTuple):
    name: str
    description: str
    items: list


def text_of(node):
    return " ".join("".join(node.itertext()).split()) if node is not None else ""


def inner(node, sections=None, parameters=None):
    """The HTML of what a node of Doxygen holds; sections and parameters go into the dictionaries given."""
    parts = [html.escape(node.text or "", quote=False)]
    for child in node:
        parts.append(of(child, sections, parameters))
        parts.append(html.escape(child.tail or "", quote=False))
    return "".join(parts)


def of(node, sections, parameters):
    if node.tag == "simplesect":
        title = text_of(node.find("title"))
        body = "".join(of(part, None, None) for part in node if part.tag == "para")
        if sections is not None:
            sections[title] = sections.get(title, "") + body
        return ""
    if node.tag == "parameterlist":
        for entry in node.findall("parameteritem"):
            names = [text_of(name) for name in entry.iter("parametername")]
            parameters[", ".join(names)] = "".join(of(part, None, None) for part in entry.find("parameterdescription"))
        return ""
    if node.tag == "para":
        body = inner(node, sections, parameters)
        if not body.strip():
            return ""
        return body if any(child.tag in ("preformatted", "verbatim") for child in node) else f"<p>{body.strip()}</p>"
    if node.tag in TAGS:
        return f"<{TAGS[node.tag]}>{inner(node, sections, parameters)}</{TAGS[node.tag]}>"
    if node.tag == "programlisting":
        lines = ["".join(inner_code(part) for part in line) for line in node.iter("codeline")]
        return "<pre><code>" + html.escape("\n".join(lines)) + "</code></pre>"
    if node.tag in SIGNS:
        return SIGNS[node.tag]
    return inner(node, sections, parameters)


def inner_code(node):
    if node.tag == "sp":
        return " "
    return (node.text or "") + "".join(inner_code(child) + (child.tail or "") for child in node)


def described(node):
    """(HTML, text, sections, parameters) of the brief and detailed description of a member or file."""
    sections, parameters, parts = {}, {}, []
    text = []
    for tag in ("briefdescription", "detaileddescription"):
        part = node.find(tag)
        if part is not None:
            parts.append(inner(part, sections, parameters).strip())
            text.append(text_of(part))
    return "".join(parts), " ".join(text), sections, list(parameters.items())


def line_of(node):
    return int(node.find("location").get("line"))


def function(node):
    description, text, sections, parameters = described(node)
    returns = text_of(node.find("type"))
    given = [tuple(text_of(parameter.find(tag)) for tag in ("type", "declname", "array"))
             for parameter in node.findall("param")]
    if not given:  # a list of `void` has no parameter
        given = [("void", "", "")]
    # Doxygen parts a pointer to an array, `uint32_t(*x)[2]`, after the star.
    written = [f"{kind}{'' if kind.endswith(('*', '(')) else ' '}{name}{array}".replace("(*", "(*").strip()
               for kind, name, array in given]
    name = text_of(node.find("name"))
    head = f"{returns}{'' if returns.endswith('*') else ' '}{name}("
    line = head + ", ".join(written) + ")"
    if len(line) > 88:
        line = head + "\n    " + ",\n    ".join(written) + ")"
    return Item("function", name, line_of(node), line, description, text, sections, parameters,
                [name for _, name, _ in given if name], returns)


def plain(kind, node, signature, members):
    description, text, sections, _ = described(node)
    return Item(kind, text_of(node.find("name")) or text_of(node.find("compoundname")), line_of(node), signature,
                description, text, sections, members, [], "")


def member(node):
    return text_of(node.find("name")), described(node)[0]


def enum(node):
    name = text_of(node.find("name"))
    return plain("enum", node, f"enum {name}", [member(value) for value in node.findall("enumvalue")])


def define(node):
    value = text_of(node.find("initializer"))
    return plain("define", node, f"#define {text_of(node.find('name'))} {value}".strip(), [])


def struct(node):
    fields, lines = [], []
    for field in node.iter("memberdef"):
        kind, name, array = (text_of(field.find(tag)) for tag in ("type", "name", "argsstring"))
        lines.append(f"    {kind}{'' if kind.endswith(('*', '(*')) else ' '}{name}{array};")
        fields.append((name, described(field)[0]))
    name = text_of(node.find("compoundname"))
    return plain("struct", node, "struct " + name + (" {\n" + "\n".join(lines) + "\n}" if lines else ""), fields)


def run_doxygen(root, out):
    """Runs Doxygen over the public headers; returns what it warned of."""
    out.mkdir(parents=True, exist_ok=True)
    settings = (HERE / "Doxyfile").read_text(encoding="utf-8") + "\n".join([
        f'INPUT = "{root / "include" / "pirouette"}"', f'STRIP_FROM_PATH = "{root / "include"}"',
        f'OUTPUT_DIRECTORY = "{out}"',
        f'INPUT_FILTER = "{sys.executable} -B {HERE / "comments.py"}"', f'WARN_LOGFILE = "{out / "warnings.txt"}"', ""])
    subprocess.run(["doxygen", "-"], input=settings, text=True, check=True, stdout=subprocess.DEVNULL, cwd=root)
    return (out / "warnings.txt").read_text(encoding="utf-8").strip()


def opaque(node):
    return text_of(node.find("definition")).split() == ["typedef", "struct"] + [text_of(node.find("name"))] * 2


def read_headers(out):
    """The headers by name, their items in the order of the text."""
    xml = out / "xml"
    structs, headers = {}, []
    for path in sorted(xml.glob("struct*.xml")):
        item = ElementTree.parse(path).getroot().find("compounddef")
        structs.setdefault(pathlib.Path(item.find("location").get("file")).name, []).append(struct(item))
    for path in sorted(xml.glob("*_8h.xml")):
        file = ElementTree.parse(path).getroot().find("compounddef")
        name = text_of(file.find("compoundname"))
        items = structs.pop(name, [])
        known = {item.name for item in items}
        for node in file.iter("memberdef"):
            kind, own = node.get("kind"), text_of(node.find("name"))
            if kind == "function":
                items.append(function(node))
            elif kind == "enum":
                items.append(enum(node))
            elif kind == "define" and not own.endswith("_H") and own != "PIR_API":
                items.append(define(node))
            elif kind == "typedef" and opaque(node) and own not in known:
                items.append(plain("struct", node, f"struct {own}", []))
        headers.append(Header(name, described(file)[0], sorted(items, key=lambda item: item.line)))
    return headers

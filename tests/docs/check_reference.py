# SPDX-License-Identifier: MIT
"""What the reference must say of every public function: what it does, its parameters, its errors, its cost."""
import re


def unnamed(function):
    """The parameters that the text does not name, but for the object that is asked and a single result."""
    results = [name for name in function.declared if name.startswith("ret_")]
    known = set(re.findall(r"\w+", " ".join([function.text, *(name for name, _ in function.parameters)])))
    asked = re.match(r"\s*(?:const )?(pir_\w+) \*", function.signature.partition("(")[2])
    own = function.declared[:1] if asked and function.name.startswith(asked[1]) else []
    return [name for name in function.declared
            if name not in known and name not in own and not (name.startswith("ret_") and len(results) == 1)]


def missing(function):
    if not function.text:
        return ["a description"]
    lacks = [f"parameter {name}" for name in unnamed(function)]
    if function.returns == "pir_status" and "Errors" not in function.sections:
        lacks.append("its errors")
    if "Cost" not in function.sections and "O(" not in function.text:
        lacks.append("its cost")
    return lacks


def check(headers):
    """Lines on what is missing, and the number of functions looked at."""
    found, count = [], 0
    for header in headers:
        for item in header.items:
            if item.kind == "function":
                count += 1
                found += [f"{header.name}: {item.name} lacks {what}" for what in missing(item)]
    return found, count


def declared(text):
    """The public functions that a header's text declares, or defines inline."""
    return re.findall(r"^(?:PIR_API|static inline) [^;(]*?\b(pir_\w+)\(", text, re.M)

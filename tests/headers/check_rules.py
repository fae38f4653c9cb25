# SPDX-License-Identifier: MIT
"""Rules that all public headers keep to.

Usage: check_rules.py ROOT RULE. A rule is the name of a function here; what breaks it is printed, one a line, and the
exit status is 1 where there is any.
"""
import pathlib
import re
import sys

COMMENT = r"/\*\*(?!<)((?:(?!\*/).)*)\*/\n"
FUNCTION = re.compile(r"^(?:PIR_API|static inline)\s+([^;({]*?)\b(pir_\w+)\(([^;{]*)\)\s*[;{]", re.M)


def plain(text):
    return re.sub(r"/\*.*?\*/", " ", text, flags=re.S)


def functions(text):
    """(result, name, parameters) of each function that a header declares."""
    for result, name, parameters in FUNCTION.findall(plain(text)):
        yield result.strip(), name, [" ".join(p.split()) for p in parameters.split(",")]


def described(text):
    """Each function's name with the comment before it; those that follow one another share it."""
    for comment, code in re.findall(COMMENT + r"((?:(?!/\*\*|\n\n).)*)", text, re.S):
        for name in re.findall(r"^(?:PIR_API|static inline) [^;(]*?\b(pir_\w+)\(", code, re.M):
            yield name, comment


def cost(root, headers):
    """Every function's own comment says what the call costs."""
    for header, text in headers:
        told = dict(described(text))
        for _, name, _ in functions(text):
            if not re.search(r"\bCost\b|\bO\(", told.get(name, "")):
                yield f"{header}: {name} does not say what it costs"


def flags(root, headers):
    """What is true or false is a bool: an int is a dimension."""
    for header, text in headers:
        for found in re.findall(r"\bint (?:\(\*)?(\w+)", plain(text)):
            if found not in ("pir_polytope_dimension", "dimension"):
                yield f"{header}: {found} is an int"


def counts(root, headers):
    """A call with a capacity says so in one form, and tests/interface/test_counts.c holds it to the rule."""
    tested = (root / "tests/interface/test_counts.c").read_text(encoding="utf-8")
    for header, text in headers:
        told = dict(described(text))
        for result, name, parameters in functions(text):
            if "size_t capacity" not in parameters:
                continue
            if result != "pir_status" or parameters[-1] != "size_t *ret_count":
                yield f"{header}: {name} has a capacity and does not end with ret_count"
            if "how many there are, also beyond the capacity" not in " ".join(told[name].replace("*", " ").split()):
                yield f"{header}: {name} does not say that the count goes beyond the capacity"
            if f'"{name}"' not in tested:
                yield f"{header}: {name} is not in the table of tests/interface/test_counts.c"


def options(root, headers):
    """A struct of options begins with its size, which an inline default sets; every call that takes one is tested."""
    tested = (root / "tests/interface/test_options.c").read_text(encoding="utf-8")
    for header, text in headers:
        for name, body in re.findall(r"^typedef struct (pir_\w+_options) \{(.*?)^\}", plain(text), re.M | re.S):
            if not body.lstrip().startswith("size_t size;"):
                yield f"{header}: {name} does not begin with its size"
            if not re.search(rf"^static inline {name} {name}_default\(void\)", text, re.M):
                yield f"{header}: {name}_default is not inline"
            if re.search(r"^\s+pir_\w+_options \w+;", body, re.M):
                yield f"{header}: {name} has another struct of options within, which cannot grow"
        for _, name, parameters in functions(text):
            if any(re.match(r"const pir_\w+_options \*", p) for p in parameters) and f'"{name}"' not in tested:
                yield f"{header}: {name} is not in the table of tests/interface/test_options.c"


def results(root, headers):
    """Results stand last."""
    for header, text in headers:
        for _, name, parameters in functions(text):
            places = [i for i, p in enumerate(parameters) if re.search(r"\bret_\w+(\[|\)|$)", p)]
            if places and places != list(range(places[0], len(parameters))):
                yield f"{header}: {name} has results before its last parameters"


def lifetimes(root, headers):
    """What counts references has _retain and _release, what has an owner _destroy; nothing else ends an object."""
    ends = {}
    for header, text in headers:
        told = dict(described(text))
        for _, name, _ in functions(text):
            found = re.fullmatch(r"(pir_\w+)_(retain|release|destroy|free|close|finish)", name)
            if found:
                ends.setdefault(found[1], set()).add(found[2])
                if found[2] != "retain" and "NULL" not in told[name]:
                    yield f"{header}: {name} does not say that NULL is accepted"
        for name in re.findall(r"^typedef struct (pir_\w+) pir_\w+;", text, re.M):
            ends.setdefault(name, set())
    for name, found in sorted(ends.items()):
        # a plain struct of references gives them back with _release
        if found not in ({"retain", "release"}, {"destroy"}) and (name, found) != ("pir_simplified", {"release"}):
            yield f"{name} ends by {', '.join(sorted(found)) or 'nothing'}"


RULES = {rule.__name__: rule for rule in (cost, flags, counts, lifetimes, options, results)}


def main(root, rule):
    headers = [(path.name, path.read_text(encoding="utf-8"))
               for path in sorted((root / "include/pirouette").glob("*.h"))]
    broken = list(RULES[rule](root, headers))
    print(*broken, sep="\n")
    return 1 if broken or len(headers) < 25 else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1]), sys.argv[2]))

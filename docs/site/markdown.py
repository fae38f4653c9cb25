# SPDX-License-Identifier: MIT
"""The Markdown of this project's pages as HTML: headings, paragraphs, lists, tables, code, links, emphasis."""
import html
import re

COMMENT = re.compile(r"^<!--.*-->\n|<!--.*?-->", re.M)
ITEM = re.compile(r"^( *)- ")
INLINE = re.compile(r"(?P<code>`[^`]+`)|!\[(?P<alt>[^\]]*)\]\((?P<image>[^)]+)\)"
                    r"|\[(?P<text>(?:[^\][]|\[[^\]]*\])+)\]\((?P<link>[^)]+)\)"
                    r"|\*\*(?P<strong>[^*]+(?:\*[^*]+\*[^*]*)*)\*\*|\*(?P<em>[^*\s][^*]*)\*|<(?P<auto>https?://[^>]+)>")


def slug(heading):
    """The anchor of a heading, as repositories' pages make it."""
    return re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")


def plain(text):
    """A line without its marks."""
    def bare(m):
        return plain(m["text"] or m["strong"] or m["em"] or m["alt"] or (m["code"] or "").strip("`"))

    return INLINE.sub(bare, text)


def inline(text, link):
    def put(m):
        if m["code"]:
            return f"<code>{html.escape(m['code'][1:-1], quote=False)}</code>"
        if m["image"]:
            return f'<img src="{html.escape(link(m["image"]))}" alt="{html.escape(m["alt"])}">'
        if m["link"]:
            return f'<a href="{html.escape(link(m["link"]))}">{inline(m["text"], link)}</a>'
        if m["auto"]:
            return f'<a href="{html.escape(m["auto"])}">{html.escape(m["auto"])}</a>'
        tag = "strong" if m["strong"] else "em"
        return f"<{tag}>{inline(m[tag], link)}</{tag}>"

    parts, at = [], 0
    for m in INLINE.finditer(text):
        parts += [html.escape(text[at:m.start()], quote=False), put(m)]
        at = m.end()
    return "".join(parts) + html.escape(text[at:], quote=False)


def table(rows, link):
    cells = [[cell.strip() for cell in re.split(r"(?<!\\)\|", row.strip().strip("|"))] for row in rows]
    right = [cell.endswith(":") for cell in cells[1]]

    def row(tag, values):
        return "<tr>" + "".join(f'<{tag}{" class=number" if far else ""}>{inline(value, link)}</{tag}>'
                                for value, far in zip(values, right)) + "</tr>"

    body = "\n".join(row("td", values) for values in cells[2:])
    return f'<div class="table"><table><thead>{row("th", cells[0])}</thead><tbody>\n{body}\n</tbody></table></div>'


def code(lines, language):
    kind = f' class="{language}"' if language else ""
    return f"<pre><code{kind}>{html.escape(chr(10).join(lines), quote=False)}</code></pre>"


def render(text, link):
    """(HTML, [(level, heading, anchor)]); `link` turns the address of a link into that of the site."""
    out, headings, lines, i = [], [], COMMENT.sub("", text).split("\n"), 0
    while i < len(lines):
        line = lines[i]
        begin = i
        if not line.strip():
            i += 1
        elif line.startswith("```"):
            i += 1
            while not lines[i].startswith("```"):
                i += 1
            out.append(code(lines[begin + 1:i], line[3:].strip()))
            i += 1
        elif line.startswith("#"):
            level = len(line) - len(line.lstrip("#"))
            words = line[level:].strip()
            headings.append((level, plain(words), slug(words)))
            out.append(f'<h{level} id="{slug(words)}">{inline(words, link)}</h{level}>')
            i += 1
        elif line.startswith("|"):
            while i < len(lines) and lines[i].startswith("|"):
                i += 1
            out.append(table(lines[begin:i], link))
        elif line.startswith("    "):
            while i < len(lines) and (lines[i].startswith("    ") or not lines[i].strip()):
                i += 1
            block = "\n".join(line[4:] for line in lines[begin:i]).rstrip().split("\n")
            out.append(code(block, ""))
        elif ITEM.match(line):
            items = []
            while i < len(lines) and (lines[i].startswith("  ") or ITEM.match(lines[i])):
                if ITEM.match(lines[i]):
                    items.append(lines[i].strip()[2:])
                else:
                    items[-1] += " " + lines[i].strip()
                i += 1
            out.append("<ul>" + "".join(f"<li>{inline(item, link)}</li>" for item in items) + "</ul>")
        else:
            while i < len(lines) and lines[i].strip() and not lines[i].startswith(("#", "|", "```")) and (
                    i == begin or not ITEM.match(lines[i])):
                i += 1
            out.append(f"<p>{inline(' '.join(line.strip() for line in lines[begin:i]), link)}</p>")
    return "\n".join(out), headings

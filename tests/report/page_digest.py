"""Prints as JSON what a page holds, read twice: as XML, which must be well-formed, and as HTML the
way browsers take it apart. Both must find the same elements and the same text.

page_digest.py PAGE
"""

import html.parser
import json
import sys
import xml.parsers.expat

VOID = {"meta", "br"}


class Reader(html.parser.HTMLParser):
    """Collects elements in document order and the text of what can be read."""

    def __init__(self):
        super().__init__(convert_charrefs=True)
        self.elements = []  # [name, attributes, own and inner text]
        self.open = []
        self.odd = []  # comments, instructions and the like

    def handle_starttag(self, tag, attrs):
        element = [tag, dict(attrs), ""]
        self.elements.append(element)
        if tag not in VOID:
            self.open.append(element)

    def handle_startendtag(self, tag, attrs):
        self.elements.append([tag, dict(attrs), ""])

    def handle_endtag(self, tag):
        if not self.open or self.open[-1][0] != tag:
            raise SystemExit(f"</{tag}> ends nothing that is open")
        self.open.pop()

    def handle_data(self, data):
        for element in self.open:
            element[2] += data

    def handle_comment(self, data):
        self.odd.append(data)

    def handle_pi(self, data):
        self.odd.append(data)

    def unknown_decl(self, data):
        self.odd.append(data)


def as_xml(content):
    elements, stack = [], []
    parser = xml.parsers.expat.ParserCreate(namespace_separator=None)
    parser.buffer_text = True

    def start(name, attributes):
        elements.append([name.lower(), {k.lower(): v for k, v in attributes.items()}, ""])
        stack.append(elements[-1])

    def data(text):
        for element in stack:
            element[2] += text

    parser.StartElementHandler = start
    parser.EndElementHandler = lambda name: stack.pop()
    parser.CharacterDataHandler = data
    parser.Parse(content, True)
    return elements


def main():
    with open(sys.argv[1], "rb") as file:
        content = file.read()
    reader = Reader()
    reader.feed(content.decode("utf-8"))
    reader.close()
    if reader.open:
        raise SystemExit(f"<{reader.open[-1][0]}> is not closed")
    xml = as_xml(content)
    for _, attributes, _ in xml + reader.elements:
        # XML makes spaces of line ends and tabs in attributes, HTML does not.
        attributes.update({key: " ".join(value.split()) for key, value in attributes.items()})
    if xml != reader.elements:
        different = [(a, b) for a, b in zip(xml, reader.elements) if a != b]
        raise SystemExit(f"XML and HTML differ: {str(different[:1])[:300]}")

    tables, row = [], []
    caption = ""
    for name, attributes, text in reader.elements:
        if name == "figcaption":
            caption = text
        elif name == "table":
            tables.append({"caption": caption, "rows": []})
        elif name == "tr":
            row = []
            tables[-1]["rows"].append(row)
        elif name in ("th", "td"):
            row.append(text)
    json.dump({
        "elements": [[name, attributes] for name, attributes, _ in reader.elements],
        "texts": [[name, text] for name, _, text in reader.elements
                  if name in ("title", "h1", "h2", "h3", "p", "li", "pre", "desc")],
        "tables": tables,
        "odd": reader.odd,
    }, sys.stdout)


main()

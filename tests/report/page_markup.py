"""What a page is made of, read without a browser."""
import html
import html.parser
import json
import re


def content_of(page):
    """Charts and packings as the page's script gets them."""
    return json.loads(re.search(r'(?s)id="content">(.*?)</script>', page)[1])


def markup_of(page):
    """The page without scripts, style sheet and plotting library."""
    return re.sub(r"(?s)(<(script|style)[^>]*>).*?</\2>", r"\1</\2>", page)


def tables_of(page):
    """Rows of texts of every table, its head first, by the heading above it."""
    found = re.findall(r"(?s)<h3>([^<]*)</h3>\s*<div class=\"wide\"><table>(.*?)</table>", page)
    cell = re.compile('<t[hd](?: class="left")?>([^<]*)</t[hd]>')
    return {heading: [list(map(html.unescape, cell.findall(row))) for row in table.split("</tr>")[:-1]] for heading, table in found}


class Tags(html.parser.HTMLParser):
    """Whether every tag is closed in the right order; the texts between tags."""

    def __init__(self, page):
        super().__init__()
        self.open, self.is_balanced, self.texts = [], True, []
        self.feed(page)
        self.close()
        self.is_balanced = self.is_balanced and not self.open

    def handle_starttag(self, tag, attrs):
        if tag not in ("meta", "img", "input", "br"):
            self.open.append(tag)

    def handle_endtag(self, tag):
        self.is_balanced = self.is_balanced and bool(self.open) and self.open.pop() == tag

    def handle_data(self, data):
        self.texts.append(data)

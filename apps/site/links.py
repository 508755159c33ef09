"""Every link and picture of the built site leads to a file that is there, and to an anchor of it; none is loaded from
the network when a page is opened.

  links.py FOLDER
"""
import html.parser
import pathlib
import sys
import urllib.parse


class Page(html.parser.HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.links, self.loaded, self.anchors = [], [], set()
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        values = dict(attributes)
        self.anchors.update(values[key] for key in ("id", "name") if values.get(key))
        if tag == "a" and values.get("href"):
            self.links.append(values["href"])
        source = values.get("src") or (values.get("href") if tag == "link" and values.get("rel") != "canonical" else None)
        if source:
            self.loaded.append(source)


def main():
    root = pathlib.Path(sys.argv[1])
    pages = {path: Page(path.read_text()) for path in sorted(root.rglob("*.html"))}
    faults, links = [], 0
    for path, page in pages.items():
        if path.name == "404.html":  # its links are from the site's top
            continue
        for source in page.loaded:
            if "//" in source:
                faults.append(f"{path}: loads {source} from the network")
        for link in page.links + page.loaded:
            parts = urllib.parse.urlsplit(link)
            if parts.scheme or parts.netloc:
                continue
            links += 1
            target = (path.parent / urllib.parse.unquote(parts.path)).resolve() if parts.path else path.resolve()
            if target.is_dir():
                target = target / "index.html"
            if not target.is_file():
                faults.append(f"{path}: no {link}")
                continue
            known = pages.get(root / target.relative_to(root.resolve()))
            if parts.fragment and known and parts.fragment not in known.anchors:
                faults.append(f"{path}: no anchor {link}")
    print("\n".join(sorted(set(faults))) or f"{len(pages)} pages, {links} links")
    sys.exit(1 if faults or links < 100 else 0)


main()

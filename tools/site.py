#!/usr/bin/python3
"""Makes the site: the pages by MkDocs, the C++ API by Doxygen in site/api. Needs no network.

usage: tools/site.py
"""
import pathlib
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
COPY = ROOT / "build_site" / "docs"
# Links of pages that lead out of docs/ are to files of the source tree, which a site does not have.
OUTSIDE = re.compile(r"\[([^]]+)\]\((?:\.\./)+(?!docs/)[^)]*\)")


def copy_pages():
    shutil.rmtree(COPY.parent, ignore_errors=True)
    shutil.copytree(ROOT / "docs", COPY)
    readme = (ROOT / "README.md").read_text()
    for name in ("CONTRIBUTING.md", "CHANGELOG.md"):
        shutil.copy(ROOT / name, COPY / name)
    readme = re.sub(r"\]\(docs/", "](", readme)
    (COPY / "README.md").write_text(re.sub(r"\[([^]]+)\]\((?!http|#)(?![^)]*\.(?:md|png|svg))[^)]*\)", r"\1", readme))
    for page in COPY.rglob("*.md"):
        text = page.read_text()
        page.write_text(OUTSIDE.sub(lambda link, page=page: link[0] if resolves(page, link[0]) else link[1], text))


def resolves(page, link):
    target = re.search(r"\(([^)#]+)", link)[1]
    file = (page.parent / target).resolve()
    return COPY in (file, *file.parents) and file.exists()


def main():
    copy_pages()
    done = subprocess.run(
        ["mkdocs", "build", "--quiet", "--strict", "--config-file", str(ROOT / "mkdocs.yml")], check=False
    )
    if done.returncode:
        sys.exit("site.py: MkDocs found faults in the pages")
    (ROOT / "site" / "api").mkdir(exist_ok=True)
    settings = (
        ROOT / "Doxyfile"
    ).read_text() + f"\nOUTPUT_DIRECTORY = {ROOT / 'build_site'}\nHTML_OUTPUT = {ROOT / 'site' / 'api'}\n"
    subprocess.run(["doxygen", "-"], input=settings, text=True, cwd=ROOT, check=True)
    print(f"site: wrote {ROOT / 'site' / 'index.html'}, API in {ROOT / 'site' / 'api' / 'index.html'}")


if __name__ == "__main__":
    main()

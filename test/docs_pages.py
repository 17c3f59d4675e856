#!/usr/bin/python3
"""The pages: their links, their spelling, and every command and program in them, run as a reader would.

usage: docs_pages.py [--guide] [--short | --long] [--gtest_output=xml:FILE] [TestCase.test ...]

A fenced block of `bash` or `python` is run; the blocks of a page one after the other, in one shell, in a folder that
looks like the workspace with its environment sourced. Comments in the page, which no reader sees, say what is
different:

    <!-- commands: long -->              run by `make test-docs-long` only: in a clean clone that the page itself builds
    <!-- commands: background -->        in a terminal of its own until the page ends; the next block waits for its
                                         train
    <!-- commands: elsewhere REASON -->  cannot be run here; REASON is one of ELSEWHERE
    <!-- commands: fails -->             each line ends with an error, as the page says
    <!-- commands: without LINE: REASON -->  lines that begin so are left out, likewise
    <!-- run: COMMAND -->                done before what follows, for instance a run that the page takes for granted

A block of `text` behind one of commands shows what they print: its lines must be in their output, in this order ("..."
stands for what is left out).
"""
import contextlib
import os
import pathlib
import re
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import unittest

import rosunit

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGES = sorted([ROOT / "README.md", ROOT / "CONTRIBUTING.md", ROOT / "CHANGELOG.md", *(ROOT / "docs").rglob("*.md")])
ELSEWHERE = {
    "display": "needs a screen; test of train_brake_rviz",
    "machines": "needs several machines; make test-cluster",
    "root": "installs or removes packages; make test-deb",
    "hours": "measures everything; make bench",
    "tested": "has a test of its own: nodes of one's own beside a train",
    "suite": "is the test suite itself",
    "noetic": "needs ROS in /opt/ros/noetic",
}
PROGRAMS = (
    "apt-get export make parallel ros2 rosbag rosbash roscore roslaunch rosmsg rosnode rosrun rosservice rosparam "
    "rostopic "
    "rsync source ssh sudo train_sim dpkg"
).split()
LONG, GUIDE = (
    "--long" in sys.argv,
    "--guide" in sys.argv,
)  # GUIDE: the commands of docs/guide; else those of all other pages
sys.argv = [word for word in sys.argv if word not in ("--long", "--short", "--guide")]
COMMENT = re.compile(r"<!-- (commands|run): (.*?) -->\s*$")
FENCE = re.compile(r"( *)```+ *(.*?)\s*$")


class Block:
    def __init__(self, page, line, language, marks, text):
        self.page, self.line, self.language, self.text = page, line, language, text
        self.marks = dict(mark.partition(" ")[::2] for mark in marks if not mark.startswith("without "))
        self.without = dict(mark[len("without ") :].rsplit(": ", 1) for mark in marks if mark.startswith("without "))

    def is_run(self):
        return (
            self.language in ("bash", "python") and "elsewhere" not in self.marks and (LONG or "long" not in self.marks)
        )

    def code(self):
        """What bash is given."""
        if self.language == "python":
            return f"/usr/bin/python3 - <<'END_OF_PYTHON'\n{self.text}END_OF_PYTHON\n"
        lines = [line for line in self.text.splitlines() if not line.startswith(tuple(self.without))]
        if "fails" in self.marks:
            lines = [f"! {line}" if line.strip() and not line.startswith("#") else line for line in lines]
        return "".join(f"{line}\n" for line in lines)

    @property
    def place(self):
        return f"{self.page.relative_to(ROOT)}:{self.line}"


def blocks(page):
    """The fenced blocks of a page and its hidden commands, in their order."""
    found, marks, inside = [], [], None
    for number, line in enumerate(page.read_text().splitlines(), 1):
        fence, comment = FENCE.match(line), COMMENT.match(line)
        if inside is not None:
            if fence and not fence[2]:
                found.append(Block(page, inside[0], inside[1], marks, "".join(f"{text}\n" for text in inside[3])))
                inside, marks = None, []
            else:
                inside[3].append(line[inside[2] :])
        elif fence:
            inside = (number, fence[2], len(fence[1]), [])
        elif comment and comment[1] == "commands":
            marks.append(comment[2])
        elif comment:
            found.append(Block(page, number, "bash", [], comment[2] + "\n"))
    assert inside is None, f"{page}:{inside[0]}: the block has no end"
    return found


def prose(page):
    """Lines of a page without its fenced blocks, numbered."""
    fenced = False
    for number, line in enumerate(page.read_text().splitlines(), 1):
        if FENCE.match(line):
            fenced = not fenced
        elif not fenced:
            yield number, line


def anchors(page):
    """Of the headings, as GitHub and MkDocs make them."""
    found = set()
    for _, line in prose(page):
        heading = re.match(r"#+ +(.*?) *$", line)
        if heading:
            text = re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", heading[1]).lower().replace("`", "")
            found.add(re.sub(r"[^\w\- ]", "", text).replace(" ", "-"))
    return found


class Links(unittest.TestCase):
    def test_every_relative_link_and_anchor_leads_somewhere(self):
        broken = []
        for page in PAGES:
            for number, line in prose(page):
                for target in re.findall(r"\]\(<?([^)\s>]+)>?\)", re.sub(r"`[^`]*`", "", line)):
                    if re.match(r"[a-z]+:", target):
                        continue
                    path, _, anchor = target.partition("#")
                    file = (page.parent / path).resolve() if path else page
                    if not file.exists():
                        broken.append(f"{page.relative_to(ROOT)}:{number}: {target}: there is no such file")
                    elif anchor and file.suffix == ".md" and anchor not in anchors(file):
                        broken.append(f"{page.relative_to(ROOT)}:{number}: {target}: there is no such heading")
        self.assertEqual([], broken)

    def test_every_page_can_be_reached_from_the_readme(self):
        reached, left = set(), [ROOT / "README.md"]
        while left:
            page = left.pop()
            if page in reached or page.suffix != ".md":
                continue
            reached.add(page)
            for _, line in prose(page):
                left += [(page.parent / path).resolve() for path in re.findall(r"\]\(([^)#\s]+\.md)", line)]
        self.assertEqual(set(), set(PAGES) - reached - {ROOT / "CHANGELOG.md"})


class Code(unittest.TestCase):
    """Headers and tests that the pages name."""

    NAMED = [page for page in PAGES if page.name not in ("CHANGELOG.md", "performance.md")]

    def test_headers_exist(self):
        headers = {str(path) for path in ROOT.glob("src/*/include/**/*.h")}
        for page in self.NAMED:
            for number, line in enumerate(page.read_text().splitlines(), 1):
                for header in re.findall(r"`((?:\w+/)+\w+\.h)`", line):
                    with self.subTest(f"{page.relative_to(ROOT)}:{number}"):
                        self.assertTrue(any(path.endswith("/" + header) for path in headers), header)

    def test_architecture_names_every_file(self):
        page = (ROOT / "docs" / "architecture.md").read_text()
        files = [*ROOT.glob("src/*/include/**/*.h"), *ROOT.glob("src/*/src/**/*.cpp")]
        self.assertGreater(len(files), 300)
        kernels = re.compile(r"(.*_kernels)_(base|avx2|avx512)")  # one law, once per instruction set
        for stem in sorted({kernels.sub(r"\1", path.stem) for path in files} - {"main"}):
            with self.subTest(stem):
                self.assertTrue(re.search(rf"\b{stem}\b", page), f"no {stem} in docs/architecture.md")

    def test_tests_exist(self):
        tests = {path.stem: path.read_text() for path in ROOT.glob("src/*/test/*_test.*")}
        programs = {path.name: path.read_text() for path in ROOT.glob("src/*/test/*.py")}
        for page in self.NAMED:
            for number, line in enumerate(page.read_text().splitlines(), 1):
                stem = program = None
                for word in re.findall(r"`([^`]+)`", line):
                    with self.subTest(f"{page.relative_to(ROOT)}:{number}"):
                        if word in programs:
                            program = word
                        elif program and re.fullmatch(r"test_\w+", word):
                            self.assertIn(f"def {word}(", programs[program])
                        if re.fullmatch(r"\w+_test", word) and word != "vehicle_test":
                            stem = word.replace("train_dynamics_", "")
                            self.assertTrue(stem in tests, stem)
                        elif stem and (name := re.fullmatch(r"([A-Z]\w+)\.(\*|[A-Z]\w+)", word)):
                            suite, test = name.groups()
                            pattern = rf"TEST\w*\({suite},\s*" + ("" if test == "*" else test + r"\)")
                            self.assertTrue(re.search(pattern, tests.get(stem, "")), f"{stem}: {word}")


class Spelling(unittest.TestCase):
    def test_pages_configuration_and_messages(self):
        checked = [
            *PAGES,
            ROOT / "config",
            ROOT / "launch",
            ROOT / "src",
            ROOT / "test",
            ROOT / "tools",
            ROOT / "Makefile",
        ]
        done = subprocess.run(
            [
                "codespell",
                "--ignore-words",
                str(ROOT / "tools" / "spelling_ignored.txt"),
                "--skip",
                "*.pyc,corpus,CMakeLists.txt",
                *map(str, checked),
            ],
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            check=False,
        )
        self.assertEqual("", done.stdout)


class Marks(unittest.TestCase):
    """No command escapes for want of a word."""

    def test_blocks_of_commands_are_called_so(self):
        nameless = [
            block.place
            for page in PAGES
            for block in blocks(page)
            if block.language in ("", "sh", "shell", "console", "text")
            and any(re.match(rf"(\S+=\S+ )*({'|'.join(PROGRAMS)})\b", line) for line in block.text.splitlines())
        ]
        self.assertEqual([], nameless, "these blocks hold commands: ```bash")

    def test_marks_are_known(self):
        for page in PAGES:
            for block in blocks(page):
                reasons = list(block.without.values())
                for mark, reason in block.marks.items():
                    self.assertIn(mark, ("long", "background", "elsewhere", "fails"), block.place)
                    reasons += [reason] if mark == "elsewhere" else []
                self.assertEqual([], [reason for reason in reasons if reason not in ELSEWHERE], block.place)
                for line in block.without:
                    self.assertIn(f"\n{line}", f"\n{block.text}", block.place)


# What the shell of a page begins with. `at` is the place of the block that is run.
PROLOGUE = r"""
set -eo pipefail
at=
trap 'code=$?; echo "FAILED: $at: exit code $code of: $BASH_COMMAND"' ERR
in_background=()
end() {
  code=$?
  trap - ERR
  for process in "${in_background[@]}"; do
    kill -TERM -- "-$process" 2>/dev/null || continue
    (sleep 20; kill -KILL -- "-$process" 2>/dev/null) &
    wait "$process" 2>/dev/null
  done
  exit $code
}
trap end EXIT
train_answers() {
  for _ in $(seq 300); do
    rosservice list 2>/dev/null | grep -q '/master/pause$' && return 0
    sleep 0.2
  done
  echo "FAILED: $at: the train in the background does not answer"
  return 1
}
"""


def script(page):
    """The page as a program of bash; empty if it has nothing to run."""
    parts, waits = [], False
    for block in filter(Block.is_run, blocks(page)):
        parts.append(f"at={block.place}; echo '== {block.place}'")
        if "background" in block.marks:
            parts.append(f"set -m\n(\n{block.code()}) > background.log 2>&1 &\nin_background+=($!)\nset +m")
            waits = True
            continue
        if waits:
            parts.append("train_answers")
            waits = False
        parts.append(block.code())
    return PROLOGUE + "\n".join(parts) if parts else ""


def workspace_like(folder):
    """Fills a folder with what a reader finds in the workspace, as links: what commands write stays in the folder."""
    for name in ("Makefile", "config", "devel", "docs", "launch", "src", "test", "tools"):
        (folder / name).symlink_to(ROOT / name)


class Commands(unittest.TestCase):
    maxDiff = None

    def run_page(self, page, folder):
        text = script(page)
        if not text:
            return
        with socket.socket() as probe:
            probe.bind(("localhost", 0))
            port = probe.getsockname()[1]
        environment = dict(
            os.environ,
            ROS_MASTER_URI=f"http://localhost:{port}",
            ROS_LOG_DIR=str(folder / "log"),
            TMPDIR=str(folder),
            PATH="/usr/bin:" + os.environ["PATH"],
        )
        if LONG:  # the reader has nothing yet
            for name in ("CMAKE_PREFIX_PATH", "ROS_PACKAGE_PATH", "PYTHONPATH", "TRAIN_BRAKE_CONFIG"):
                environment.pop(name, None)
            text = re.sub(r"\n(?=at=)", "\n[ ! -e devel/setup.bash ] || . devel/setup.bash\n", text, 1)
        with open(folder / "output.log", "w") as log:  # no pipe, which a process left behind would hold open
            process = subprocess.Popen(
                ["bash", "-c", text],
                cwd=folder,
                env=environment,
                stdin=subprocess.DEVNULL,
                stdout=log,
                stderr=log,
                start_new_session=True,
            )
            try:
                code = process.wait(5400 if LONG else 400)
            except subprocess.TimeoutExpired:
                code = "no end"
            with contextlib.suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)
        output = (folder / "output.log").read_text(errors="replace")
        background = folder / "background.log"
        more = f"\n-- in the background:\n{background.read_text()[-3000:]}" if background.exists() else ""
        self.assertEqual(0, code, f"\n{output[-6000:]}{more}")
        self.check_shown(page, output)

    def check_shown(self, page, output):
        """Blocks of `text` hold what was printed."""
        words = lambda line: " ".join(line.split())
        last, shown = None, False
        for block in blocks(page):
            if block.language in ("bash", "python"):
                last, shown = block, block.is_run() and "background" not in block.marks
            elif block.language == "text" and last is not None and shown:
                printed = output.split(f"== {last.place}\n", 1)[-1].split(f"\n== {page.relative_to(ROOT)}:")[0]
                rest = iter([words(line) for line in printed.splitlines()])
                for line in filter(None, map(words, block.text.splitlines())):
                    if line != "...":
                        self.assertIn(line, rest, f"{block.place}: not in the output, or not there:\n{printed}")


def add_tests():
    def test_of(page):
        def test(self):
            if LONG:
                self.run_page(page, self.clone)
                return
            with tempfile.TemporaryDirectory() as folder:
                workspace_like(pathlib.Path(folder))
                self.run_page(page, pathlib.Path(folder))

        return test

    for page in PAGES:
        if (LONG or GUIDE == (page.parent.name == "guide")) and script(page):
            name = re.sub(r"\W", "_", str(page.relative_to(ROOT).with_suffix("")))
            setattr(Commands, f"test_{name}", test_of(page))


@classmethod
def clone(cls):
    """Of what is committed; the pages build it."""
    cls.folder = tempfile.TemporaryDirectory()
    cls.addClassCleanup(cls.folder.cleanup)
    cls.clone = pathlib.Path(cls.folder.name) / "clone"
    subprocess.run(["git", "clone", "--quiet", str(ROOT), str(cls.clone)], check=True)


if LONG:
    Commands.setUpClass = clone
add_tests()

if __name__ == "__main__":
    if shutil.which("codespell") is None:
        sys.exit("docs_pages.py: there is no codespell here: apt-get install codespell")
    if LONG or len(sys.argv) > 1 and not sys.argv[1].startswith("--gtest"):
        unittest.main(verbosity=2, argv=[sys.argv[0]] + [a for a in sys.argv[1:] if not a.startswith("--gtest")])
    if GUIDE:
        del Links, Marks, Spelling
    rosunit.unitrun("train_brake", "docs_guide" if GUIDE else "docs_pages", "__main__")

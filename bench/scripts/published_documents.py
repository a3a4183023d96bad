"""Figures in the documents of this project that come from bench/published, and the check that they are those.

A mark in a Markdown file names where its text comes from:

  <!--= sixdof table pairs/pairs.json --wide --markdown -->TEXT<!--=-->     what the command prints, run in bench/published
  <!--= collection/results.json collection.against_exact[query=distance,algorithm=fcl-rss].ratio .1f -->11.3<!--=-->
                                                             a value of a file, by a path of keys, in Python's format
  <!--= sixdof ... | head 12 -->TEXT<!--=-->                 the first lines; `grep WORDS` for lines that have the words,
                                                             `from WORDS`, `until WORDS` for lines from or before one,
                                                             `tables` for Markdown tables, their titles and faults;
                                                             `columns NAME...` for these columns of a Markdown table;
                                                             `pivot NAMED VALUE` for a column per value of column NAMED
  <!--= fenced recommend/random.txt | head 4 -->TEXT<!--=--> what a command printed when it was measured
  <!--= report equal_time equivalent/*.json -->TEXT<!--=-->  a table of `sixdof report --markdown`, without its title
  <!--= fcl-distance.ratio -->11.3<!--=-->                    a figure that bench/scripts/figures.json names
  <!--= parts pairs.date -->TEXT<!--=-->                     a fact of a part: commit, date, machine, commands

Files may have the wild cards of a shell. A part that is not published yet leaves "(not measured)".
`KEY[NAME=VALUE,...]` takes the one element of a list whose members are these. A text that begins with a line break stands on
lines of its own; `fenced` in front of a command puts it into a code block.

bench/scripts/drawings.json names the figures of bench/published, each with the figure, files and options of `sixdof report`.
"""

import json
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "fixtures"))
from whole_file import write_whole  # noqa: E402

PUBLISHED = ROOT / "bench/published"
FACTS = PUBLISHED / "parts.json"
FIGURES = ROOT / "bench/scripts/figures.json"  # {name: [FILE, PATH, FORMAT]}
DRAWINGS = ROOT / "bench/scripts/drawings.json"  # {SVG: [FIGURE, FILES AND OPTIONS...]}
# Parts that hold all that they are compared with; their sections name their commits.
OWN_COMMIT = {"casts", "contacts", "deform", "depths", "equivalent", "losses", "paper", "rivals", "scenarios"}
PROGRAM = ROOT / "build/release/bin/sixdof"
MARK = re.compile(r"<!--= (?P<what>.*?) -->(?P<text>.*?)<!--=-->", re.S)
STEP = re.compile(r"(?P<key>[^.\[\]]+)(\[(?P<chosen>[^\]]*)\])?\.?")


class Stale(Exception):
    """A mark that cannot be filled, or published files of several commits."""


class Missing(Stale):
    """A part that a mark needs is not published."""


def facts():
    """{part: commit, date, machine, ...}; empty where nothing is published."""
    return json.loads(FACTS.read_text(encoding="utf-8")) if FACTS.exists() else {}


def report_missing(file):
    """@raises Missing for a file of a part that is not published; Stale where the part is"""
    name = str(file.relative_to(PUBLISHED)) if isinstance(file, pathlib.Path) else file
    raise (Stale if name.split("/")[0] in facts() else Missing)(f"{name} is not there")


def selected(value, path):
    """The element of a JSON value that a path names. @raises Stale"""
    for step in STEP.finditer(path):
        key, chosen = step["key"], step["chosen"]
        if not isinstance(value, dict) or key not in value:
            raise Stale(f"{path}: there is no '{key}'")
        value = value[key]
        if chosen is None:
            continue
        wanted = dict(pair.split("=", 1) for pair in chosen.split(","))
        found = [each for each in value if all(str(each.get(name)) == text for name, text in wanted.items())]
        if len(found) != 1:
            raise Stale(f"{path}: {len(found)} elements are [{chosen}], not one")
        value = found[0]
    return value


def value_of(words):
    """FILE PATH [FORMAT], or the name of a figure, as text. @raises Stale"""
    named = json.loads(FIGURES.read_text(encoding="utf-8"))
    if len(words) == 1 and words[0] not in named:
        raise Stale(f"{FIGURES.name} names no '{words[0]}'")
    words = named.get(words[0], words)
    file = FACTS if words[0] == "parts" else PUBLISHED / words[0]
    if not file.exists() or (words[0] == "parts" and words[1].split(".")[0] not in facts()):
        report_missing(words[1].split(".")[0] if words[0] == "parts" else file)
    value = selected(json.loads(file.read_text(encoding="utf-8")), words[1])
    return format(value, words[2]) if len(words) > 2 else str(value)


def expanded(words):
    """The words with the wild cards of files in bench/published replaced. @raises Stale"""
    found = []
    for word in words:
        is_pattern = "*" in word and "/" in word
        files = sorted(str(file.relative_to(PUBLISHED)) for file in PUBLISHED.glob(word)) if is_pattern else [word]
        if not files or any("/" in file and file.endswith(".json") and not (PUBLISHED / file).exists() for file in files):
            report_missing(word)
        found += files
    return found


def report_file(name, words, kind, program):
    """One of the files that `sixdof report WORDS... --KIND FOLDER` writes. @raises Stale"""
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run([program, "report", *expanded(words), kind, folder], cwd=PUBLISHED, capture_output=True,
                              text=True, check=False)
        file = pathlib.Path(folder) / name
        if done.returncode or not file.exists():
            raise Stale(f"sixdof report: {done.stderr.strip() or f'nothing to show in {name}'}")
        return file.read_text(encoding="utf-8")


def report_table(name, files, program):
    """Lines of a table of `sixdof report --markdown`. @raises Stale"""
    text = report_file(f"{name}.md", files, "--markdown", program)
    return "\n".join(line for line in text.splitlines() if line.startswith("|"))


def output_of(command, program):
    """What a command prints in bench/published, or what stands in a text file there. @raises Stale"""
    if command[0] == "report":
        return report_table(command[1], command[2:], program)
    if command[0] != "sixdof":
        file = PUBLISHED / command[0]
        if not file.exists():
            report_missing(file)
        return file.read_text(encoding="utf-8")
    done = subprocess.run([program, *expanded(command[1:])], cwd=PUBLISHED, capture_output=True, text=True, check=False)
    if done.returncode:
        raise Stale(f"{shlex.join(command)}: {done.stderr.strip()}")
    return done.stdout


def cells_of(line):
    """Of a row of a Markdown table."""
    return [cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]]


def row_of(cells):
    return f"| {' | '.join(cells)} |"


def places_of(header, names):
    """Where columns stand; names are written without backslashes. @raises Stale"""
    if not header:
        raise Stale("there is no table")
    there = [cell.replace("\\", "") for cell in header]
    gone = [name for name in names if name not in there]
    if gone:
        raise Stale(f"no column is called {gone[0]}, but {', '.join(there)}")
    return [there.index(name) for name in names]


def with_columns(lines, names):
    """These columns of a Markdown table, in this order."""
    table = [cells_of(line) for line in lines]
    places = places_of(table[0] if table else [], names)
    return [row_of([cells[place] for place in places]) for cells in table]


def pivoted(lines, named, value):
    """A table with a row for equal cells in all other columns, and a column of values for each cell of column `named`."""
    header, _, *table = [cells_of(line) for line in lines] or [[], []]
    name_place, value_place = places_of(header, [named, value])
    others = [place for place in range(len(header)) if place not in (name_place, value_place)]
    columns = list(dict.fromkeys(cells[name_place] for cells in table))
    rows = {}
    for cells in table:
        rows.setdefault(tuple(cells[place] for place in others), {})[cells[name_place]] = cells[value_place]
    return [row_of([header[place] for place in others] + columns), "|" + "---|" * len(others) + "---:|" * len(columns),
            *(row_of([*key, *(values.get(column, "") for column in columns)]) for key, values in rows.items())]


def chosen_lines(lines, words):
    """The lines that a filter keeps."""
    name, *arguments = words
    if name == "head":
        return lines[:int(arguments[0])]
    if name == "tables":
        return [line for line in lines if not line or line.startswith(("|", "#", "- !", "- \\!"))]
    if name == "grep":
        return [line for line in lines if any(text in line for text in arguments)]
    if name == "columns":
        return with_columns(lines, arguments)
    if name == "pivot":
        return pivoted(lines, *arguments)
    if name in ("from", "until"):
        places = [i for i, line in enumerate(lines) if arguments[0] in line]
        if not places:
            raise Stale(f"no line has '{arguments[0]}'")
        return lines[places[0]:] if name == "from" else lines[:places[0]]
    raise Stale(f"there is no filter '{name}'")


def text_of(what, program):
    """What stands in a mark. @raises Stale"""
    try:
        return found_text(what, program)
    except Missing:
        return "(not measured)"


def found_text(what, program):
    parts = [shlex.split(part) for part in re.split(r" \| ", what)]
    fenced = parts[0][0] == "fenced"
    command = parts[0][fenced:]
    if command[0] not in ("sixdof", "report") and not command[0].endswith(".txt"):
        return value_of(command)
    lines = output_of(command, program).strip("\n").splitlines()
    for words in parts[1:]:
        lines = chosen_lines(lines, words)
    text = "\n".join(lines).strip("\n")
    return f"\n```\n{text}\n```\n" if fenced else f"\n{text}\n"


def documents():
    """The Markdown files with marks."""
    listed = subprocess.run(["git", "ls-files", "*.md"], cwd=ROOT, check=True, capture_output=True, text=True).stdout
    return [file for file in (ROOT / name for name in listed.split()) if "<!--= " in file.read_text(encoding="utf-8")]


def filled(file, program):
    """The file's text with all marks filled anew. @raises Stale with the file and the mark"""
    def fill(mark):
        try:
            return f"<!--= {mark['what']} -->{text_of(mark['what'], program)}<!--=-->"
        except Stale as stale:
            raise Stale(f"{file.relative_to(ROOT)}: <!--= {mark['what']} -->: {stale}") from stale
    return MARK.sub(fill, file.read_text(encoding="utf-8"))


def can_draw(program):
    """Whether `sixdof report` can: it needs Node.js and the libraries that the build takes from npm."""
    libraries = pathlib.Path(program).resolve().parents[1] / "share/sixdof/report/vendor"
    return bool(shutil.which("node")) and (libraries / "vega.min.js").exists()


def drawings(program):
    """(file in bench/published, its text) of every figure whose data are published. @raises Stale"""
    for name, (figure, *words) in json.loads(DRAWINGS.read_text(encoding="utf-8")).items():
        try:
            yield PUBLISHED / name, report_file(f"{figure}.svg", words, "--svg", program)
        except Missing:
            continue


def one_commit():
    """@raises Stale if published parts, but for those of OWN_COMMIT, are of several commits"""
    commits = {part["commit"] for name, part in facts().items() if name not in OWN_COMMIT}
    if len(commits) > 1:
        raise Stale(f"published results are of {len(commits)} commits: {', '.join(sorted(commits))}; run bench/publish")


def write(program=PROGRAM):
    """Fills all marks. @returns exit code"""
    one_commit()
    for file in documents():
        text = filled(file, program)
        if text != file.read_text(encoding="utf-8"):
            file.write_text(text, encoding="utf-8")
            print(f"{file.relative_to(ROOT)}: written")
    for file, text in drawings(program):
        write_whole(file, text)
    return 0


def check(program=PROGRAM):
    """Names the marks that are stale. @returns exit code, 1 if there is one"""
    one_commit()
    stale = 0
    for file in documents():
        for mark in MARK.finditer(file.read_text(encoding="utf-8")):
            now = text_of(mark["what"], program)
            if now != mark["text"]:
                stale += 1
                print(f"{file.relative_to(ROOT)}: <!--= {mark['what']} -->: says {mark['text'][:200]!r}, "
                      f"published is {now[:200]!r}", file=sys.stderr)
    for file, text in drawings(program) if can_draw(program) else []:
        if not file.exists() or file.read_text(encoding="utf-8") != text:
            stale += 1
            print(f"{file}: another figure than `sixdof report` draws now", file=sys.stderr)
    return 1 if stale else 0

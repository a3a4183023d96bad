"""What bench/gate found: stages with a verdict, and the same as text, Markdown, JUnit XML and JSON."""

import dataclasses
import re
import xml.etree.ElementTree as xml

GREEN, RED, NOT_JUDGED = "green", "red", "not judged"
MOST_FINDINGS = 20  # in a comment; all are in the text and in the JUnit file
MOST_NOTES = 8
# Characters that XML 1.0 cannot hold.
NOT_XML = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


@dataclasses.dataclass
class Finding:
    """Something red. @param row its name, or that of a program"""
    row: str
    text: str


@dataclasses.dataclass
class Stage:
    """@param rows names of what was judged; @param why of a stage that could not be judged"""
    name: str
    rows: list = dataclasses.field(default_factory=list)
    findings: list = dataclasses.field(default_factory=list)
    notes: list = dataclasses.field(default_factory=list)
    why: str = ""

    @property
    def verdict(self):
        if self.findings:
            return RED
        return NOT_JUDGED if self.why else GREEN

    def summary(self):
        """One line without the verdict."""
        if self.verdict == NOT_JUDGED:
            return self.why
        rows = f"{len(self.rows)} rows" if len(self.rows) != 1 else "1 row"
        red = len({finding.row for finding in self.findings})
        return f"{rows} judged" + (f", {red} red" if red else "") + (f"; {self.why}" if self.why else "")


def verdict_of(stages):
    """Red if a stage is; green if one is and none is red."""
    verdicts = {stage.verdict for stage in stages}
    return RED if RED in verdicts else GREEN if GREEN in verdicts else NOT_JUDGED


def text_of(stages):
    lines = []
    for stage in stages:
        lines += [f"RED      {stage.name}: {one.row}: {one.text}" for one in stage.findings]
        lines += [f"note     {stage.name}: {note}" for note in stage.notes]
    lines += [f"{stage.verdict.upper() if stage.verdict == RED else stage.verdict:<10} {stage.name}: {stage.summary()}"
              for stage in stages]
    return "\n".join([*lines, f"gate: {verdict_of(stages)}"]) + "\n"


def cell(text):
    """Text that neither ends a cell of a table nor marks anything up."""
    return re.sub(r"([\\`*_{}\[\]<>#|~])", r"\\\1", " ".join(text.split()))


def markdown_of(stages):
    """At most 40 lines."""
    lines = [f"### sixdof gate: {verdict_of(stages)}", "", "| stage | verdict | |", "|---|---|---|"]
    lines += [f"| {stage.name} | {stage.verdict} | {cell(stage.summary())} |" for stage in stages]
    findings = [(stage, one) for stage in stages for one in stage.findings]
    if findings:
        lines.append("")
        lines += [f"- **{stage.name}** {cell(one.row)}: {cell(one.text)}" for stage, one in findings[:MOST_FINDINGS]]
    if len(findings) > MOST_FINDINGS:
        lines.append(f"- and {len(findings) - MOST_FINDINGS} more")
    notes = [f"- {stage.name}: {cell(note)}" for stage in stages for note in stage.notes]
    if notes:
        lines += ["", *notes[:MOST_NOTES]]
    return "\n".join(lines) + "\n"


def junit_of(stages):
    """A test suite for every stage, a test case for every row; a stage that is not judged is a skipped case."""
    root = xml.Element("testsuites", name="sixdof gate")
    for stage in stages:
        by_row = {}
        for finding in stage.findings:
            by_row.setdefault(finding.row, []).append(finding.text)
        names = [*by_row, *(row for row in stage.rows if row not in by_row)]
        skipped = 1 if stage.verdict == NOT_JUDGED else 0
        suite = xml.SubElement(root, "testsuite", name=stage.name, tests=str(len(names) + skipped), failures=str(len(by_row)),
                               errors="0", skipped=str(skipped))
        for name in names:
            case = xml.SubElement(suite, "testcase", classname=f"sixdof.{stage.name}", name=NOT_XML.sub("?", name))
            if name in by_row:
                text = NOT_XML.sub("?", "\n".join(by_row[name]))
                xml.SubElement(case, "failure", message=text.splitlines()[0] if text else "").text = text
        if skipped:
            case = xml.SubElement(suite, "testcase", classname=f"sixdof.{stage.name}", name=stage.name)
            xml.SubElement(case, "skipped", message=NOT_XML.sub("?", stage.why))
    xml.indent(root)
    return xml.tostring(root, encoding="unicode", xml_declaration=True) + "\n"


def json_of(stages):
    return {"verdict": verdict_of(stages),
            "stages": [dataclasses.asdict(stage) | {"verdict": stage.verdict} for stage in stages]}

"""Reads PTX: modules of variables and functions, and a function's body as statements."""
import re
from dataclasses import dataclass, field

BITS = {"pred": 1, "b8": 8, "u8": 8, "s8": 8, "b16": 16, "u16": 16, "s16": 16, "b32": 32, "u32": 32, "s32": 32,
        "f32": 32, "b64": 64, "u64": 64, "s64": 64, "f64": 64}


def size(kind):
    """Bytes of a type in memory."""
    return max(BITS[kind] // 8, 1)


class PtxError(Exception):
    """Unsupported PTX; the text says which."""


@dataclass
class Variable:
    space: str  # global, const, shared, local or param
    kind: str
    name: str
    count: int  # elements; 0 for shared memory whose size the launch gives
    align: int
    initial: str = ""

    @property
    def bytes(self):
        return self.count * size(self.kind)


@dataclass
class Function:
    name: str
    entry: bool
    results: list
    parameters: list
    body: str
    max_threads: int = 1024  # .maxntid


@dataclass
class Module:
    variables: list = field(default_factory=list)
    declared: list = field(default_factory=list)  # functions without a body, before they are defined
    functions: list = field(default_factory=list)
    files: dict = field(default_factory=dict)  # .file numbers to names, without those of the CUDA toolkit


VARIABLE = re.compile(r"\.(?P<space>global|const|shared|local|param)\s+(?:\.attribute\([^)]*\)\s*)?"
                      r"(?:\.align\s+(?P<align>\d+)\s+)?\.(?P<kind>\w+)\s+"
                      r"(?:\.ptr\s*(?:\.\w+\s+)*?(?:\.align\s+\d+\s+)?)?"
                      r"(?P<name>[\w$]+)(?P<array>\[(?P<count>\d*)\])?(?:\s*=\s*(?P<initial>.*))?$", re.S)


def variable(text):
    match = VARIABLE.match(" ".join(text.split()))
    if not match or match["kind"] not in BITS:
        raise PtxError(f"variable: {text.strip()}")
    count = 1 if not match["array"] else int(match["count"] or 0)
    return Variable(match["space"], match["kind"], match["name"], count, int(match["align"] or size(match["kind"])),
                    match["initial"] or "")


def split(text):
    """At commas outside brackets."""
    parts, depth, begin = [], 0, 0
    for at, char in enumerate(text):
        depth += (char in "{[(") - (char in "}])")
        if char == "," and depth == 0:
            parts.append(text[begin:at].strip())
            begin = at + 1
    last = text[begin:].strip()
    return parts + [last] if last else parts


def parameters(text):
    return [variable(part) for part in split(text)]


def closing(text, at):
    """Where the bracket that opens at `at` is closed."""
    pairs = {"{": "}", "(": ")"}
    depth, opened, closed = 0, text[at], pairs[text[at]]
    while True:
        depth += (text[at] == opened) - (text[at] == closed)
        if depth == 0:
            return at
        at += 1


HEAD = re.compile(r"(?:\.(?:visible|weak|extern|common)\s+)*(?P<what>\.(?:entry|func|global|const|shared))\b")


def parse(text):
    """A module of the text that nvcc writes."""
    module = Module()
    text = re.sub(r"//[^\n]*", "", text)
    text = re.sub(r"\.section\s+\S+\s*\{[^}]*\}", "", text)  # debug sections
    for number, name in re.findall(r'^\s*\.file\s+(\d+)\s+"([^"]*)".*$', text, re.M):
        if "/cuda" not in name:
            module.files[number] = name.rsplit("/", 1)[-1]
    text = re.sub(r"^\s*\.(file|version|target|address_size)\b[^\n]*$", "", text, flags=re.M)
    text = re.sub(r"^(\s*\.loc\b[^\n]*)$", r"\1;", text, flags=re.M)
    at = 0
    while rest := text[at:].lstrip():
        at = len(text) - len(rest)
        head = HEAD.match(text, at)
        if not head:
            raise PtxError(f"at the module's level: {rest[:120]!r}")
        if head["what"] in (".entry", ".func"):
            at = function(module, text, head)
        else:
            end = text.index(";", at)
            module.variables.append(variable(text[head.start("what"):end]))
            at = end + 1
    return module


def function(module, text, head):
    """Takes a function into the module and returns where it ends."""
    at = head.end()

    def skip():
        nonlocal at
        while text[at].isspace():
            at += 1

    def bracketed():
        nonlocal at
        skip()
        if text[at] != "(":
            return []
        end = closing(text, at)
        inside, at = text[at + 1:end], end + 1
        return parameters(inside)

    results = bracketed() if head["what"] == ".func" else []
    skip()
    name = re.compile(r"[\w$]+").match(text, at)[0]
    at += len(name)
    taken = bracketed()
    body = text.find("{", at)
    semicolon = text.find(";", at)
    if semicolon >= 0 and (body < 0 or semicolon < body):
        module.declared.append(Function(name, False, results, taken, ""))
        return semicolon + 1
    end = closing(text, body)
    defined = Function(name, head["what"] == ".entry", results, taken, text[body + 1:end])
    if bound := re.search(r"\.(?:max|req)ntid\s+(\d+)(?:\s*,\s*(\d+))?(?:\s*,\s*(\d+))?", text[at:body]):
        defined.max_threads = int(bound[1]) * int(bound[2] or 1) * int(bound[3] or 1)
    module.functions.append(defined)
    return end + 1


LABEL = re.compile(r"[$\w]+:")


def statements(body):
    """Of a function's body, in order: "{" and "}" of scopes, "NAME:" of labels, statements without their semicolon."""
    at = 0
    while at < len(body):
        if body[at].isspace() or body[at] == ";":
            at += 1
        elif body[at] in "{}":
            yield body[at]
            at += 1
        elif label := LABEL.match(body, at):
            yield label[0]
            at = label.end()
        else:
            end = body.index(";", at)
            yield " ".join(body[at:end].split())
            at = end + 1

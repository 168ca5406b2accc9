#!/usr/bin/env python3
"""PTX to C++ over machine.h: translate.py FROM.ptx TO.cpp. A function of the PTX becomes a function of C++, a statement
a statement and a register a variable. What is not known here ends the translation with its text: a row of
INSTRUCTIONS (tables.py) or a method do_NAME teaches it."""
import re
import sys
from pathlib import Path

import ptx
from ptx import BITS, PtxError, size
from tables import ATOMIC, INSTRUCTIONS, NAMES, REGISTER, ROUNDED, SPECIAL, TYPE, UNSIGNED

def identifier(name):
    return ("r_" if name.startswith("%") else "v_") + re.sub(r"\W", "_", name.lstrip("%"))


def label(name):
    return "L_" + re.sub(r"\W", "_", name)


class Body:
    """Translates a function's statements."""

    def __init__(self, function, module, points):
        self.function, self.module, self.points = function, module, points
        self.scopes = [{v.name: "memory" for v in function.parameters + function.results}]
        self.shared = place_shared(function, module)
        self.line = "?"
        self.called = {}  # From where the code of a position was inlined, by the position.

    def translate(self):
        return [self.statement(text) for text in ptx.statements(self.function.body)]

    def statement(self, text):
        if text == "{":
            self.scopes.append({})
            return "{"
        if text == "}":
            self.scopes.pop()
            return "}"
        if text.endswith(":"):
            return label(text[:-1]) + ":;"
        if text.startswith("."):
            return self.directive(text)
        guard = re.match(r"@(!?)(%?\w+)\s+(.*)$", text)
        try:
            if guard:
                return f"if ({guard[1]}{identifier(guard[2])}) {{ {self.instruction(guard[3])} }}"
            return self.instruction(text)
        except (PtxError, KeyError, ValueError, IndexError) as error:
            raise PtxError(f"{self.function.name}: {text}\n  {type(error).__name__}: {error}") from error

    def directive(self, text):
        if text.startswith(".loc "):
            self.locate(text)
            return ""
        if text.startswith(".pragma"):
            return ""
        if text.startswith(".reg"):
            return self.registers(text)
        declared = ptx.variable(text)
        if declared.space == "shared":
            return ""  # place_shared() has seen it.
        self.scopes[-1][declared.name] = "memory"
        return f"alignas(16) uint8_t {identifier(declared.name)}[{max(declared.bytes, 8)}];"

    def locate(self, text):
        """.loc FILE LINE COLUMN[, function_name NAME, inlined_at FILE LINE COLUMN]: the lines of the program that the
        next instructions are of, innermost first; those of the toolkit's headers are left out."""
        at = tuple(text.split(",")[0].split()[1:4])
        inlined = re.search(r"inlined_at (\d+) (\d+) (\d+)", text)
        self.called[at] = inlined.groups() if inlined else None
        chain = []
        while at and len(chain) < 16:
            chain.append(at)
            at = self.called.get(at)
        named = [f"{self.module.files[file]}:{line}" for file, line, _ in chain if file in self.module.files]
        self.line = " < ".join(named) or "?"

    def registers(self, text):
        kind, names = re.match(r"\.reg\s+\.(\w+)\s+(.*)$", text).groups()
        held = REGISTER[kind]
        declared = []
        for name in ptx.split(names):
            many = re.match(r"(%?\w+)<(\d+)>$", name)
            declared += [f"{many[1]}{k}" for k in range(int(many[2]))] if many else [name]
        self.scopes[-1] |= {name: held for name in declared}
        # Before the first label, values; in a scope that a goto may enter, none.
        value = "{}" if len(self.scopes) == 1 else ""
        return f"{held} {', '.join(identifier(name) + value for name in declared)};"

    # Operands

    def found(self, name):
        return next((scope[name] for scope in reversed(self.scopes) if name in scope), None)

    def address(self, name):
        if name in self.shared:
            return f"(t.shared + {self.shared[name]})"
        if self.found(name) == "memory" or any(v.name == name for v in self.module.variables):
            return f"uint64_t({identifier(name)})"
        raise PtxError(f"symbol {name}")

    def value(self, text, kind):
        """An operand read as a type."""
        held = TYPE[kind]
        if text.startswith("!"):
            return "!" + self.value(text[1:], kind)
        if text in SPECIAL:
            return f"as<{held}>({SPECIAL[text]})"
        if self.found(text) not in (None, "memory"):
            return f"as<{held}>({identifier(text)})"
        if real := re.match(r"0[fF]([0-9a-fA-F]{8})$|0[dD]([0-9a-fA-F]{16})$", text):
            bits = f"0x{real[1]}u" if real[1] else f"0x{real[2]}ull"
            return f"as<{held}>({bits})"
        if re.match(r"-?(0[xX][0-9a-fA-F]+|[0-9]+)U?$", text):
            number = int(text.rstrip("U"), 0)
            if kind == "pred":
                return str(number != 0).lower()
            if kind in ("f32", "f64"):
                raise PtxError(f"integer {text} as {kind}")
            return f"{held}({number % 2**64}ull)"
        if symbol := re.match(r"([A-Za-z_$][\w$]*)(?:\+(-?\d+))?$", text):
            return f"as<{held}>({self.address(symbol[1])} + {symbol[2] or 0})"
        raise PtxError(f"operand {text}")

    def memory(self, text):
        """[BASE+OFFSET] as an address of 64 bits. Addresses of shared memory fit into 32."""
        match = re.match(r"\[\s*([%\w$.]+)\s*(?:\+\s*(-?\d+))?\s*\]$", text)
        base, offset = match[1], match[2] or "0"
        held = self.found(base)
        if held in (None, "memory"):
            return f"({self.address(base)} + {offset})"
        return f"uint64_t({held}({identifier(base)} + {offset}))"

    def result(self, name, expression):
        if name == "_":
            return f"(void)({expression});"
        return f"{identifier(name)} = to<{self.found(name)}>({expression});"

    def point(self, what):
        self.points.append((self.function.name, self.line, what))
        return f"points[{len(self.points) - 1}]"

    # Instructions

    def instruction(self, text):
        match = re.match(r"([a-z]\w*)((?:[.:]+\w+)*)\s*(.*)$", text)
        if not match:
            raise PtxError("not an instruction")
        name, rest = match[1], match[3]
        modifiers = [m for m in re.split(r"[.:]+", match[2]) if m]
        if method := getattr(self, f"do_{name}", None):
            return method(modifiers, ptx.split(rest) if name != "call" else rest)
        if name not in INSTRUCTIONS:
            raise PtxError("no such instruction here")
        return self.computed(name, modifiers, ptx.split(rest))

    def computed(self, name, modifiers, operands):
        named, ignored, kinds = INSTRUCTIONS[name]
        *modifiers, kind = modifiers
        if unknown := set(modifiers) - named - ignored:
            raise PtxError(f"modifier {', '.join(sorted(unknown))}")
        double = f"{kind[0]}{2 * BITS[kind]}" if "wide" in modifiers else kind
        kinds = [{"T": kind, "W": double, "4": "u32", "p": "pred"}[k] for k in kinds]
        variant = [UNSIGNED.get(m, m) if name == "setp" else m for m in modifiers if m in named]
        function = "_".join([NAMES.get(name, name)] + variant)
        shown = "u" + kind[1:] if name in ("shr", "bfe", "bfind") and kind[0] == "b" else kind
        taken = ", ".join(self.value(o, k) for o, k in zip(operands[1:], kinds, strict=True))
        expression = f"{function}<{TYPE[shown]}>({taken})"
        if "|" in operands[0]:
            both = operands[0].split("|")
            return f"{{ const bool x = {expression}; {self.result(both[0], 'x')} {self.result(both[1], '!x')} }}"
        return self.result(operands[0], expression)

    def do_mov(self, modifiers, operands):
        (kind,) = modifiers
        into, source = operands
        if source.startswith("{"):
            parts = ptx.split(source[1:-1])
            width = BITS[kind] // len(parts)
            packed = " | ".join(f"{TYPE[kind]}({self.value(part, f'b{width}')}) << {k * width}"
                                for k, part in enumerate(parts))
            return self.result(into, packed)
        if into.startswith("{"):
            parts = ptx.split(into[1:-1])
            width = BITS[kind] // len(parts)
            unpacked = " ".join(self.result(p, f"uint{width}_t(x >> {k * width})") for k, p in enumerate(parts))
            return f"{{ const {TYPE[kind]} x = {self.value(source, kind)}; {unpacked} }}"
        return self.result(into, self.value(source, kind))

    def do_cvta(self, modifiers, operands):
        return self.result(operands[0], self.value(operands[1], modifiers[-1]))

    def do_cvt(self, modifiers, operands):
        *rounding, into, source = modifiers
        if unknown := set(rounding) - ROUNDED - {"rn", "sat"}:
            raise PtxError(f"modifier {', '.join(sorted(unknown))}")
        if "sat" in rounding and into[0] != "f":
            raise PtxError("saturating integers")
        expression = self.value(operands[1], source)
        for rounded in ROUNDED & set(rounding):
            expression = f"{rounded}({expression})"
        expression = f"cvt<{TYPE[into]}>({expression})"
        if "sat" in rounding:
            expression = f"saturate({expression})"
        return self.result(operands[0], expression)

    def access(self, modifiers):
        """Of ld and st: the type, whether the access is of global memory and without order, and its order."""
        known = {"global", "shared", "local", "param", "const", "nc", "weak", "volatile", "relaxed", "acquire",
                 "release", "gpu", "sys", "cta", "v2", "v4", "L1", "no_allocate", "evict_first", "evict_last"}
        *modifiers, kind = modifiers
        if unknown := set(modifiers) - known:
            raise PtxError(f"modifier {', '.join(sorted(unknown))}")
        order = next((m for m in modifiers if m in ("volatile", "relaxed", "acquire", "release")), None)
        weak = order is None and not {"shared", "local", "param", "const"} & set(modifiers)
        return kind, weak, order

    def at(self, operand, kind, parts):
        return f"const uint64_t at = aligned<{parts * size(kind)}>({self.memory(operand)});"

    def do_ld(self, modifiers, operands):
        kind, weak, order = self.access(modifiers)
        load = f"{'loadWeak' if weak else 'load'}<{TYPE[kind]}>"
        before = "yield(); " if order else ""
        after = " acquire();" if order == "acquire" and "cta" not in modifiers else ""
        parts = ptx.split(operands[0][1:-1]) if operands[0].startswith("{") else [operands[0]]
        loads = " ".join(f"const auto x{k} = {load}(at + {k * size(kind)});" for k in range(len(parts)))
        results = " ".join(self.result(part, f"x{k}") for k, part in enumerate(parts))
        return f"{before}{{ {self.at(operands[1], kind, len(parts))} {loads} {results} }}{after}"

    def do_st(self, modifiers, operands):
        kind, weak, order = self.access(modifiers)
        store = f"{'storeWeak' if weak else 'store'}<{TYPE[kind]}>"
        parts = ptx.split(operands[1][1:-1]) if operands[1].startswith("{") else [operands[1]]
        stores = " ".join(f"{store}(at + {k * size(kind)}, {self.value(p, kind)});" for k, p in enumerate(parts))
        return f"{{ {self.at(operands[0], kind, len(parts))} {stores} }}" + (" maybeYield();" if order else "")

    def do_atom(self, modifiers, operands):
        *modifiers, kind = modifiers
        compute = [m for m in modifiers if m in ATOMIC]
        known = {"global", "shared", "relaxed", "acquire", "release", "acq_rel", "gpu", "sys", "cta"}
        if len(compute) != 1 or set(modifiers) - known - set(compute):
            raise PtxError("which operation?")
        acquires = {"acquire", "acq_rel"} & set(modifiers) and "cta" not in modifiers and "shared" not in modifiers
        third = f"const {TYPE[kind]} c = {self.value(operands[3], kind)}; " if len(operands) > 3 else ""
        expression = (f"atomic<{TYPE[kind]}>({self.memory(operands[1])}, {str(bool(acquires)).lower()}, "
                      f"[&]({TYPE[kind]} old) -> {TYPE[kind]} {{ return {ATOMIC[compute[0]]}; }})")
        return (f"{{ const {TYPE[kind]} b = {self.value(operands[2], kind)}; {third}"
                f"{self.result(operands[0], expression)} }}")

    def do_red(self, modifiers, operands):
        return self.do_atom(modifiers, ["_"] + operands)

    def do_membar(self, modifiers, operands):
        return "maybeYield();" if modifiers == ["cta"] else "acquire(); maybeYield();"

    def do_fence(self, modifiers, operands):
        return self.do_membar(["cta"] if "cta" in modifiers else ["gl"], operands)

    def do_nanosleep(self, modifiers, operands):
        return "yield();"

    def do_trap(self, modifiers, operands):
        return 'trap("trap");'

    def do_exit(self, modifiers, operands):
        if not self.function.entry:
            raise PtxError("exit in a function that is called")
        return "return;"

    def do_ret(self, modifiers, operands):
        return "return;"

    def do_bra(self, modifiers, operands):
        return f"goto {label(operands[0])};"

    def do_call(self, modifiers, rest):
        match = re.match(r"(?:\(([^)]*)\)\s*,\s*)?([\w$]+)\s*(?:,\s*\(([^)]*)\))?$", rest)
        taken = [identifier(v) for v in ptx.split(match[1] or "") + ptx.split(match[3] or "")]
        return f"{identifier(match[2])}({', '.join(['t'] + taken)});"

    # Collectives

    def do_shfl(self, modifiers, operands):
        sync, mode, _ = modifiers
        kept, _, within = operands[0].partition("|")
        value, source, clamp, members = (self.value(o, "b32") for o in operands[1:])
        call = f"shuffle(Shuffle::{mode}, {value}, {source}, {clamp}, {members}, p, {self.point('shuffle')})"
        return (f"{{ bool p; const uint32_t x = {call}; {self.result(kept, 'x')} "
                f"{self.result(within, 'p') if within else ''} }}")

    def do_vote(self, modifiers, operands):
        (mode,) = set(modifiers) - {"sync", "b32", "pred"}
        members = self.value(operands[2], "b32")
        vote = self.value(operands[1], "pred")
        if mode == "all":
            return self.result(operands[0], f"ballot(!{vote}, {members}, {self.point('all')}) == 0")
        votes = f"ballot({vote}, {members}, {self.point(mode)})"
        return self.result(operands[0], {"ballot": votes, "any": f"{votes} != 0"}[mode])

    def do_bar(self, modifiers, operands):
        if modifiers == ["warp", "sync"]:
            return f"warpBarrier({self.value(operands[0], 'b32')}, {self.point('barrier of a warp')});"
        reduces = "red" in modifiers
        if len(operands) != (3 if reduces else 1) or operands[1 if reduces else 0] != "0":
            raise PtxError("a barrier that is not the first, or of some threads alone")
        if set(modifiers) <= {"sync", "cta", "aligned"}:
            return f"(void)blockBarrier(false, {self.point('barrier of a block')});"
        if set(modifiers) == {"red", "or", "pred"}:
            expression = f"blockBarrier({self.value(operands[-1], 'pred')}, {self.point('barrier of a block')})"
            return self.result(operands[0], expression)
        raise PtxError("this barrier")

    do_barrier = do_bar


def place_shared(function, module):
    """Names of shared memory in a function's body with their places behind t.shared, in C++. Sets the function's
    static_shared, in bytes."""
    inner = [ptx.variable(text) for text in ptx.statements(function.body) if text.startswith(".shared")]
    used = set(re.findall(r"[\w$]+", function.body))
    places, end = {}, 0
    for declared in [v for v in module.variables if v.space == "shared" and v.name in used] + inner:
        if declared.count == 0:
            places[declared.name] = "t.dynamicShared"
            continue
        end = -(-end // declared.align) * declared.align
        places[declared.name] = str(end)
        end += declared.bytes
    if places and not function.entry:
        raise PtxError(f"{function.name}: shared memory in a function that is called")
    function.static_shared = -(-end // 16) * 16
    return places


def signature(function):
    name = identifier(function.name)
    if function.entry:
        return f"void {name}(Thread& t, const uint8_t* parameters)"
    results = [f"uint8_t* {identifier(v.name)}" for v in function.results]
    taken = [f"const uint8_t* {identifier(v.name)}" for v in function.parameters]
    return f"void {name}({', '.join(['Thread& t'] + results + taken)})"


def place_parameters(function):
    """Offsets of an entry's parameters, and the size of all."""
    offsets, end = [], 0
    for taken in function.parameters:
        end = -(-end // taken.align) * taken.align
        offsets.append(end)
        end += taken.bytes
    return offsets, end


def translate(text):
    module = ptx.parse(text)
    lines = ['#include "machine.h"', "using namespace emulator;", "namespace {", "extern Point points[];"]
    for declared in module.variables:
        if declared.space in ("global", "const"):
            initial = declared.initial if declared.initial.startswith("{") else f"{{{declared.initial}}}"
            lines.append(f"alignas({max(declared.align, 16)}) {TYPE[declared.kind]} {identifier(declared.name)}"
                         f"[{max(declared.count, 1)}] = {initial};")
    points, entries = [], []
    lines += [signature(function) + ";" for function in module.declared + module.functions if not function.entry]
    for function in module.functions:
        body = Body(function, module, points).translate()
        lines.append(signature(function) + " {")
        if function.entry:
            offsets, end = place_parameters(function)
            entries.append((function, offsets, end))
            lines += [f"const uint8_t* const {identifier(taken.name)} = parameters + {offset};"
                      for taken, offset in zip(function.parameters, offsets)]
        lines += [line for line in body if line] + ["}"]
    rows = ", ".join("{" + ", ".join(f'"{text}"' for text in point) + "}" for point in points or [("", "", "")])
    lines.append(f"Point points[] = {{{rows}}};")
    for at, (function, offsets, _) in enumerate(entries):
        sizes = [taken.bytes for taken in function.parameters]
        lines.append(f"const uint32_t offsets{at}[] = {{{', '.join(map(str, offsets or [0]))}}}, "
                     f"sizes{at}[] = {{{', '.join(map(str, sizes or [0]))}}};")
    rows = [f'{{"{f.name}", {identifier(f.name)}, {end}, {f.static_shared}, {f.max_threads}, {len(offsets)}, offsets{at}, sizes{at}}}'
            for at, (f, offsets, end) in enumerate(entries)]
    lines.append(f"const Kernel kernels[] = {{{', '.join(rows)}}};")
    lines.append(f"const Registration registration(kernels, {len(rows)}, points, {len(points)});")
    return "\n".join(lines + ["}  // namespace"]) + "\n"


if __name__ == "__main__":
    try:
        Path(sys.argv[2]).write_text(translate(Path(sys.argv[1]).read_text()))
    except PtxError as problem:
        sys.exit(f"error: {sys.argv[1]}: PTX that translate.py does not know: {problem}")

"""What PTX is in C++: types, special registers, and the instructions that only compute (instructions.h)."""
TYPE = {"pred": "bool", "f32": "float", "f64": "double"}
TYPE |= {f"{kind}{bits}": f"{'int' if kind == 's' else 'uint'}{bits}_t" for kind in "bus" for bits in (8, 16, 32, 64)}
# Registers hold bits; those of 8 bits are kept in 16.
REGISTER = TYPE | {f"s{bits}": f"uint{bits}_t" for bits in (16, 32, 64)}

SPECIAL = {f"%{name}.{axis}": f"t.{name}[{at}]" for name in ("tid", "ntid", "ctaid", "nctaid")
           for at, axis in enumerate("xyz")}
SPECIAL |= {"%laneid": "t.laneid", "%envreg1": "uint32_t(t.workspace >> 32)", "%envreg2": "uint32_t(t.workspace)",
            "%clock64": "clock64()",
            "%lanemask_eq": "(1u << t.laneid)", "%lanemask_lt": "((1u << t.laneid) - 1)",
            "%lanemask_le": "(~0u >> (31 - t.laneid))", "%lanemask_ge": "(~0u << t.laneid)",
            "%lanemask_gt": "(~1u << t.laneid)"}

# Instructions that compute: modifiers that name another function, modifiers without effect here, and the types of the
# operands: T the instruction's, W twice as wide after .wide, 4 = u32, p = pred.
COMPARISONS = {"eq", "ne", "lt", "le", "gt", "ge", "lo", "ls", "hi", "hs", "equ", "neu", "ltu", "leu", "gtu", "geu",
               "num", "nan"}
NONE = frozenset()
INSTRUCTIONS = {
    "add": (NONE, {"rn"}, "TT"), "sub": (NONE, {"rn"}, "TT"), "mul": ({"lo", "hi", "wide"}, {"rn"}, "TT"),
    "mad": ({"lo", "hi", "wide"}, NONE, "TTW"), "fma": (NONE, {"rn"}, "TTT"), "div": (NONE, {"rn"}, "TT"),
    "rem": (NONE, NONE, "TT"), "neg": (NONE, NONE, "T"), "abs": (NONE, NONE, "T"), "min": (NONE, NONE, "TT"),
    "max": (NONE, NONE, "TT"), "sqrt": (NONE, {"rn"}, "T"), "rcp": (NONE, {"rn"}, "T"), "copysign": (NONE, NONE, "TT"),
    "rsqrt": ({"approx", "ftz"}, NONE, "T"), "ex2": ({"approx", "ftz"}, NONE, "T"),
    "and": (NONE, NONE, "TT"), "or": (NONE, NONE, "TT"), "xor": (NONE, NONE, "TT"), "not": (NONE, NONE, "T"),
    "shl": (NONE, NONE, "T4"), "shr": (NONE, NONE, "T4"), "popc": (NONE, NONE, "T"), "clz": (NONE, NONE, "T"),
    "brev": (NONE, NONE, "T"), "bfind": ({"shiftamt"}, NONE, "T"), "bfi": (NONE, NONE, "TT44"),
    "bfe": (NONE, NONE, "T44"), "prmt": (NONE, NONE, "TTT"), "lop3": (NONE, NONE, "TTT4"),
    "shf": ({"l", "r", "clamp", "wrap"}, NONE, "TT4"), "selp": (NONE, NONE, "TTp"), "setp": (COMPARISONS, NONE, "TT"),
}
# PTX's comparisons of unsigned integers: here the type makes the difference.
UNSIGNED = {"lo": "lt", "ls": "le", "hi": "gt", "hs": "ge"}
NAMES = {"setp": "set", "and": "bit_and", "or": "bit_or", "xor": "bit_xor", "not": "bit_not"}
ATOMIC = {"add": "add(old, b)", "min": "min(old, b)", "max": "max(old, b)", "exch": "b", "and": "bit_and(old, b)",
          "or": "bit_or(old, b)", "xor": "bit_xor(old, b)", "cas": "old == b ? c : old",
          "inc": "old >= b ? 0 : old + 1", "dec": "old == 0 || old > b ? b : old - 1"}
ROUNDED = {"rni", "rzi", "rmi", "rpi"}

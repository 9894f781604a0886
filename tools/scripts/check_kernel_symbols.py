#!/usr/bin/env python3
"""Kernel objects may define symbols of their own namespace only.

    tools/scripts/check_kernel_symbols.py [--nm NM] NAMESPACE OBJECT|ARCHIVE...
    tools/scripts/check_kernel_symbols.py avx2_f32 build/dev/CMakeFiles/mw_kernels_avx2_f32.dir/kernels/*.o

Why: an inline function or template that several files use is compiled into each of their objects,
as a weak symbol, and the linker keeps one copy for the whole program: the first that it meets. That
is sound only when all copies are the same. A kernel object is compiled for AVX2 or AVX-512; if it
holds a weak copy of, say, std::vector<double>::_M_realloc_insert, then that copy may end up serving
code that never asked for those instructions, and the program dies on a CPU without them. Nothing
warns: the one-definition rule is broken, no diagnostic required.

So every global or weak symbol that a kernel object defines must mention manyworlds::<NAMESPACE>
(in its scope, its template arguments or its parameters): then no other object can define it. Symbols
of xsimd that carry the instruction set's own tag as a template argument are as safe, since only
kernels of that instruction set know the tag. Local symbols cannot clash.

Inlining hides leaks, so this runs on an unoptimised build too (preset symbols).
"""

import argparse
import re
import subprocess
import sys

# nm's letters for symbols that other objects can bind to. 'u' is a unique global.
SHARED = set("ABCDGRSTVWuvwi")
# Bookkeeping that AddressSanitizer adds per global of the object.
SANITIZER = re.compile(r"__odr_asan")
# The tags of an instruction set and of those it builds on, in a mangled xsimd symbol: how they look,
# and what would make the symbol another set's.
XSIMD_TAGS = {
    "avx2": (re.compile(r"[34]avx2?(?!\d)"), re.compile(r"\davx512")),
    "avx512": (re.compile(r"(\d|simd_)avx512"), None),
}


def own(symbol, namespace):
    """True when the mangled name mentions manyworlds::<namespace>; S_ stands for a repetition."""
    component = f"{len(namespace)}{namespace}"
    return re.search(rf"(10manyworlds|S[0-9A-Z]*_){component}", symbol) is not None


def own_xsimd(symbol, isa):
    """True for an xsimd template that is instantiated for this instruction set alone."""
    if "5xsimd" not in symbol or isa not in XSIMD_TAGS:
        return False
    own_tag, foreign_tag = XSIMD_TAGS[isa]
    return (own_tag.search(symbol) is not None
            and (foreign_tag is None or foreign_tag.search(symbol) is None))


def baseline_std(symbol, letter, isa):
    """True for weak std functions of the scalar kernels: compiled without ISA flags, as anywhere."""
    return isa == "scalar" and letter in "Ww" and re.match(r"_ZN?K?St", symbol) is not None


def defined(nm, files):
    """(file, letter, mangled name) of each symbol that the files define for others."""
    run = subprocess.run([nm, "--defined-only", "--print-file-name", "--format=posix", *files],
                         check=True, stdout=subprocess.PIPE, text=True)
    for line in run.stdout.splitlines():
        # "file.o: name letter address size"; archives print "lib.a[file.o]: ...".
        file, _, rest = line.partition(": ")
        fields = rest.split()
        if len(fields) >= 2 and fields[1] in SHARED:
            yield file, fields[1], fields[0]


def demangle(names):
    run = subprocess.run(["c++filt"], input="\n".join(names), check=True,
                         stdout=subprocess.PIPE, text=True)
    return run.stdout.splitlines()


def main():
    parser = argparse.ArgumentParser(description="symbols of kernel objects outside a namespace")
    parser.add_argument("--nm", default="nm")
    parser.add_argument("namespace", help="<isa>_<precision>, as in avx2_f32")
    parser.add_argument("files", nargs="+")
    options = parser.parse_args()
    isa = options.namespace.split("_")[0]

    symbols = list(defined(options.nm, options.files))
    leaks = [(file, letter, name) for file, letter, name in symbols
             if not (own(name, options.namespace) or own_xsimd(name, isa)
                     or baseline_std(name, letter, isa) or SANITIZER.match(name))]
    for (file, letter, _), text in zip(leaks, demangle([name for _, _, name in leaks])):
        print(f"{file}: {letter} {text}: outside manyworlds::{options.namespace}")
    if not symbols:
        print(f"{options.namespace}: the files define no symbols at all")
        return 1
    print(f"{options.namespace}: {len(options.files)} files, {len(symbols)} symbols, "
          f"{len(leaks)} outside the namespace")
    return 1 if leaks else 0


if __name__ == "__main__":
    sys.exit(main())

"""The machine of the measurements: processor, cores, memory, compiler. No name of a host, no path."""
import os
import pathlib
import re
import subprocess


def _first(pattern, text, otherwise):
    found = re.search(pattern, text, re.MULTILINE)
    return found.group(1).strip() if found else otherwise


def _virtual(cpu_info):
    return " (virtual machine)" if re.search(r"^flags\s*:.*\bhypervisor\b", cpu_info, re.MULTILINE) else ""


def _instruction_sets(cpu_info):
    flags = set(_first(r"^flags\s*:(.*)$", cpu_info, "").split())
    known = (("AVX-512", "avx512f"), ("AVX2", "avx2"), ("SSE2", "sse2"))
    return ", ".join(name for name, flag in known if flag in flags)


def describe():
    """Pairs of label and text."""
    cpu_info = pathlib.Path("/proc/cpuinfo").read_text()
    memory_kb = int(_first(r"^MemTotal:\s*(\d+)", pathlib.Path("/proc/meminfo").read_text(), "0"))
    lscpu = subprocess.run(["lscpu"], stdout=subprocess.PIPE, text=True, env={**os.environ, "LC_ALL": "C"}).stdout
    system = pathlib.Path("/etc/os-release").read_text()
    compiler = subprocess.run(["c++", "--version"], stdout=subprocess.PIPE, text=True).stdout.splitlines()[0]
    caches = ", ".join(f"{level} {_first(rf'^{level} cache:(.*)$', lscpu, '?')}" for level in ("L1d", "L2", "L3"))
    family = _first(r"^cpu family\s*:(.*)$", cpu_info, "?")
    return [
        ("processor", f"{_first(r'^model name.*:(.*)$', cpu_info, 'unknown')}, family {family}{_virtual(cpu_info)}"),
        ("cores", str(cores())),
        ("instruction sets", _instruction_sets(cpu_info) or "?"),
        ("caches", caches),
        ("memory", f"{memory_kb / 2**20:.0f} GiB"),
        ("system", _first(r'^PRETTY_NAME="(.*)"', system, "unknown")),
        ("compiler", compiler),
    ]


def lanes():
    """Numbers in a register of the widest set: vehicles of a pack."""
    sets = dict(describe())["instruction sets"]
    return 8 if "AVX-512" in sets else 4 if "AVX2" in sets else 2


def cores():
    return len(re.findall(r"^processor\s*:", pathlib.Path("/proc/cpuinfo").read_text(), re.MULTILINE))

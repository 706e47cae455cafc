"""Mitsuba 3 on the CPU: finds the LLVM library that its compiler loads at run time, and chooses the variant.

    from mitsuba_llvm import dr, mi

DRJIT_LIBLLVM_PATH, where set, wins. Otherwise the newest libLLVM of the system is taken: Dr.Jit by itself takes what the linker
finds first, and aborts with LLVM 15 and 16 ("Cannot select fminimum").
"""
from __future__ import annotations

import os
import re
from pathlib import Path

OLDEST_LLVM = 17  # 15 and 16 abort; 19 was tried
LLVM_FOLDERS = ("/usr/lib/x86_64-linux-gnu", "/usr/lib/aarch64-linux-gnu", "/usr/lib64", "/usr/local/lib")
INSTALL = "pip install mitsuba, and Debian's package libllvm19 (apt-get install libllvm19)"


def newest_llvm() -> Path | None:
    """The libLLVM with the highest version, at least OLDEST_LLVM."""
    found: dict[int, Path] = {}
    for folder in (*map(Path, LLVM_FOLDERS), *Path("/usr/lib").glob("llvm-*/lib")):
        for path in folder.glob("libLLVM*.so*"):
            version = re.match(r"libLLVM(?:-|\.so\.)(\d+)", path.name)
            if version and int(version[1]) >= OLDEST_LLVM:
                found.setdefault(int(version[1]), path)
    return found[max(found)] if found else None


if "DRJIT_LIBLLVM_PATH" not in os.environ:
    library = newest_llvm()
    if library is None:
        raise ImportError(f"Mitsuba needs LLVM {OLDEST_LLVM} or newer and there is none in {', '.join(LLVM_FOLDERS)}; install: "
                          f"{INSTALL}; or name the library in DRJIT_LIBLLVM_PATH")
    os.environ["DRJIT_LIBLLVM_PATH"] = str(library)

try:
    import drjit as dr
    import mitsuba as mi
except ImportError as error:
    raise ImportError(f"Mitsuba 3 is not installed ({error}); install: {INSTALL}") from error

mi.set_variant("llvm_ad_rgb")
mi.set_log_level(mi.LogLevel.Error)  # its warnings say that sample counts are rounded up: Peer.render tells

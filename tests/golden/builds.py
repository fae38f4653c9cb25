# SPDX-License-Identifier: MIT
"""Builds the golden histories in every way that this machine can, runs them, and prints a table.

gcc and clang at -O0 to -O3, each with all versions of the kernels that the processor runs; aarch64 under qemu-user and
i386 where cross compilers are there. What cannot be made is listed as not run. Exit status 1 where a hash differs.

Usage: builds.py [--work FOLDER] [--sysroot FOLDER] [--only NAME...]

  --work     where builds go; build-golden in the current folder
  --sysroot  where packages of cross compilers, qemu-user-static and GMP were unpacked, where they are not installed
  --only     the builds of these names
"""
import argparse
import os
import pathlib
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
KEPT = ROOT / "tests/golden/golden.txt"
WITHOUT = ["tools", "bench", "hdf5", "mpi", "ccd", "ompl", "bullet"]
CROSS = {
    # limbs of 64 bits, NEON
    "aarch64": {"prefix": "aarch64-linux-gnu-", "pc": "aarch64-linux-gnu", "family": "aarch64", "cpu": "armv8-a",
                "args": [], "run": ["qemu-aarch64-static", "qemu-aarch64"]},
    # limbs of 32 bits; doubles in SSE registers: x87 keeps more bits than a double has
    "i386": {"prefix": "i686-linux-gnu-", "pc": "i386-linux-gnu", "family": "x86", "cpu": "i686",
             "args": ["-msse2", "-mfpmath=sse"], "run": []},
}


class Absent(Exception):
    """This machine cannot make the build."""


def setup_arguments(level):
    options = {"default_library": "static", "buildtype": "plain", "optimization": level, "b_ndebug": "true",
               "tests": "auto", "cpp_std": "c++17"}
    return [f"-D{k}={v}" for k, v in options.items()] + [f"-D{name}=disabled" for name in WITHOUT]


def native(compiler):
    if not shutil.which(compiler):
        raise Absent(f"no {compiler}")
    return [], dict(os.environ, CC=compiler)


def cross(name, work, sysroot):
    """The arguments and the environment of a cross build, whose file is written to `work`."""
    target = CROSS[name]
    root = str(sysroot or "")
    path = f"{root}/usr/bin:{os.environ['PATH']}"
    compiler = shutil.which(target["prefix"] + "gcc", path=path)
    if not compiler:
        raise Absent(f"no {target['prefix']}gcc")
    wrapper = next((shutil.which(run, path=path) for run in target["run"] if shutil.which(run, path=path)), None)
    if target["run"] and not wrapper:
        raise Absent(f"no {target['run'][-1]}")
    pc = f"{root}/usr/lib/{target['pc']}/pkgconfig"
    if not os.path.exists(f"{pc}/gmp.pc"):
        raise Absent(f"no GMP for {name}")
    lines = ["[binaries]", f"c = '{compiler}'", f"ar = '{shutil.which(target['prefix'] + 'ar', path=path)}'",
             "pkgconfig = 'pkg-config'"]
    lines += [f"exe_wrapper = '{wrapper}'"] if wrapper else []
    lines += ["[properties]", f"pkg_config_libdir = '{pc}:{root}/usr/share/pkgconfig'"]
    lines += [f"sys_root = '{root}'"] if root else []
    arguments = target["args"] + ([f"-isystem{root}/usr/include/{target['pc']}"] if root else [])
    lines += ["[built-in options]", f"c_args = {arguments!r}", "c_link_args = ['-static']", "[host_machine]",
              "system = 'linux'", f"cpu_family = '{target['family']}'", f"cpu = '{target['cpu']}'",
              "endian = 'little'"]
    file = work / f"{name}.cross"
    file.write_text("\n".join(lines) + "\n")
    environment = dict(os.environ, PATH=path)
    if root:
        environment["LD_LIBRARY_PATH"] = f"{root}/usr/lib/x86_64-linux-gnu"
    return ["-Dprefer_static=true", "--cross-file", str(file)], environment


def run(command, environment, folder):
    done = subprocess.run(command, env=environment, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          text=True, check=False)
    return done.returncode, done.stdout


def build_and_run(name, how, level, work):
    """Rows of (kernels, differing hashes)."""
    arguments, environment = how()
    folder = work / name.replace(" ", "")
    if not (folder / "build.ninja").exists():
        shutil.rmtree(folder, ignore_errors=True)
        status, text = run(["meson", "setup", str(folder), str(ROOT), *setup_arguments(level), *arguments], environment,
                           work)
        if status:
            raise Absent("meson setup failed: " + text.strip().splitlines()[-1])
    status, text = run(["ninja", "-C", str(folder), "tests/golden/golden"], environment, work)
    if status:
        raise Absent("the build failed: " + text.strip().splitlines()[-1])
    binary = folder / "tests/golden/golden"
    wrapper = re.search(r"exe_wrapper = '(.*)'", (work / f"{name.split()[0]}.cross").read_text()) if arguments else None
    _, text = run([*([wrapper.group(1)] if wrapper else []), str(binary), str(KEPT)], environment, work)
    rows = re.findall(r"^kernels (\w+): (\d+) histories, (\d+) differ$", text, re.M)
    if not rows:
        raise Absent("the program failed: " + text.strip()[-200:])
    return rows, text


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--work", type=pathlib.Path, default=pathlib.Path("build-golden"))
    parser.add_argument("--sysroot", type=pathlib.Path)
    parser.add_argument("--only", nargs="*")
    options = parser.parse_args()
    work = options.work.resolve()
    work.mkdir(parents=True, exist_ok=True)
    builds = [(f"{compiler} -O{level}", lambda c=compiler: native(c), level)
              for compiler in ("gcc", "clang") for level in "0123"]
    builds += [(f"{name} -O{level}", lambda n=name: cross(n, work, options.sysroot), level)
               for name in CROSS for level in "02"]
    differ = 0
    print("| build | kernels | histories | differ |\n| --- | --- | ---: | ---: |")
    for name, how, level in builds:
        if options.only and name not in options.only:
            continue
        try:
            rows, text = build_and_run(name, how, level, work)
            for kernels, histories, wrong in rows:
                print(f"| {name} | {kernels} | {histories} | {wrong} |", flush=True)
                differ += int(wrong)
            if any(int(wrong) for _, _, wrong in rows):
                print(text, file=sys.stderr)
        except Absent as absent:
            print(f"| {name} | not run: {absent} | | |", flush=True)
    return 1 if differ else 0


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/python3
"""Lists the failed tests of a build folder after a run of ctest and closes with "N passed, N failed".

Exit code 0 only if tests ran and none failed.
"""
import pathlib
import sys
import xml.etree.ElementTree as ElementTree


def main():
    build = pathlib.Path(sys.argv[1])
    passed, skipped, failed = 0, 0, []
    for path in sorted(build.glob("test_results/**/*.xml")):
        for case in ElementTree.parse(path).iter("testcase"):
            if case.find("failure") is not None or case.find("error") is not None:
                failed.append("%s: %s.%s" % (path.stem, case.get("classname"), case.get("name")))
            elif case.find("skipped") is not None or case.get("status") == "notrun":
                skipped += 1
            else:
                passed += 1
    # A test program can also fail after its last test case (a leak, a crash at exit): only ctest knows.
    programs = build / "Testing/Temporary/LastTestsFailed.log"
    if not failed and programs.exists():
        failed = programs.read_text().split()

    for name in failed:
        print("FAILED", name)
    if skipped:
        print("%d skipped" % skipped)
    print("%d passed, %d failed" % (passed, len(failed)))
    return 1 if failed or not passed else 0


if __name__ == "__main__":
    sys.exit(main())

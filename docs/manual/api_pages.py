"""Pages of the C++ API: one for each stage, with a section for each public header, of what Doxygen found in it."""

import pathlib
import xml.etree.ElementTree as ElementTree

HEADERS = pathlib.Path(__file__).resolve().parents[2] / "lib" / "include"
DIRECTIVES = {"class": "doxygenclass", "struct": "doxygenstruct", "function": "doxygenfunction", "enum": "doxygenenum",
              "typedef": "doxygentypedef", "variable": "doxygenvariable"}


def items_of(xml):
    """(header, line, kind, name) of all that namespaces hold; functions with the types that they take."""
    for entry in ElementTree.parse(xml / "index.xml").getroot().iter("compound"):
        if entry.get("kind") not in ("class", "struct", "namespace"):
            continue
        [compound] = ElementTree.parse(xml / f"{entry.get('refid')}.xml").getroot().iter("compounddef")
        name = compound.findtext("compoundname")
        if entry.get("kind") != "namespace":
            place = compound.find("location")
            yield place.get("file"), int(place.get("line")), entry.get("kind"), name
            continue
        for member in compound.iter("memberdef"):
            place = member.find("location")
            kind, full = member.get("kind"), f"{name}::{member.findtext('name')}"
            if kind == "function":
                types = ["".join(parameter.find("type").itertext()) for parameter in member.findall("param")]
                full += f"({', '.join(types)})"
            yield place.get("declfile") or place.get("file"), int(place.get("declline") or place.get("line")), kind, full


def grouped(xml):
    found = {}
    classes = {name for _, _, kind, name in items_of(xml) if kind in ("class", "struct")}
    for header, line, kind, name in items_of(xml):
        # What is in a class is on its own entry; what is private to headers is in a namespace of that name.
        if name.rpartition("::")[0] in classes or "::detail::" in name:
            continue
        found.setdefault(header, []).append((line, kind, name))
    return found


def write_api(xml, folder):
    """`xml`: Doxygen's output. A header of which Doxygen tells nothing is an error."""
    found = grouped(xml)
    folder.mkdir()
    for stage in sorted(path for path in (HEADERS / "bandvox").iterdir() if path.is_dir()):
        lines = [f"# C++: {stage.name}", ""]
        for header in sorted(stage.glob("*.h")):
            name = header.relative_to(HEADERS).as_posix()
            if name not in found:
                raise SystemExit(f"{name} declares nothing that Doxygen finds")
            lines += [f"## {header.name}", "", "```cpp", f"#include <{name}>", "```", "", "```{eval-rst}"]
            for _, kind, item in sorted(found[name]):
                lines += [f".. {DIRECTIVES[kind]}:: {item}"]
                lines += ["   :members:", "   :undoc-members:"] if kind in ("class", "struct") else []
                lines += [""]
            lines += ["```", ""]
        (folder / f"{stage.name}.md").write_text("\n".join(lines), encoding="utf-8")

"""Put a built documentation into the site, in a folder for its version.

`python packaging/site.py BUILT SITE VERSION` replaces SITE/VERSION, which is `dev` or the number of
a release. The start of the site leads to the newest release, or to `dev` before the first, and
`versions.html` lists all.
"""

import re
import shutil
import sys
from pathlib import Path

START = """\
<!doctype html>
<meta charset="utf-8">
<title>nacre</title>
<meta http-equiv="refresh" content="0; url={0}/index.html">
<a href="{0}/index.html">nacre {0}</a>
"""
LIST = """\
<!doctype html>
<html lang="en">
<meta charset="utf-8">
<title>Versions of nacre</title>
<h1>Versions of nacre</h1>
<ul>
{}
</ul>
</html>
"""
RELEASE = re.compile(r"\d+\.\d+\.\d+")


def versions(site: Path) -> list[str]:
    """Return the versions in a site, the newest first: `dev`, then the releases."""
    names = [folder.name for folder in site.iterdir() if folder.is_dir()]
    releases = [name for name in names if RELEASE.fullmatch(name)]
    releases.sort(key=lambda name: [int(part) for part in name.split(".")], reverse=True)
    return ["dev"] * ("dev" in names) + releases


def place(built: Path, site: Path, version: str) -> None:
    """Replace a version in a site, and write its start and its list of versions."""
    if version != "dev" and not RELEASE.fullmatch(version):
        raise ValueError(f"the version must be dev or as 1.2.3, got {version!r}")
    shutil.rmtree(site / version, ignore_errors=True)
    shutil.copytree(built, site / version)
    names = versions(site)
    newest = next((name for name in names if name != "dev"), "dev")
    links = "\n".join(f'<li><a href="{name}/index.html">{name}</a></li>' for name in names)
    (site / "index.html").write_text(START.format(newest), encoding="utf-8")
    (site / "versions.html").write_text(LIST.format(links), encoding="utf-8")
    (site / ".nojekyll").touch()  # folders whose names begin with _ are served


if __name__ == "__main__":
    place(Path(sys.argv[1]), Path(sys.argv[2]), sys.argv[3])

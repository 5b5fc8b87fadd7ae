# SPDX-License-Identifier: MIT
"""The plugin of QGIS: its forms, and with QGIS its algorithms, whose files are those of the command line."""

import importlib.util
import json
import os
import shutil
import subprocess
import sys
import zipfile

import numpy as np
import pytest

SOURCE = os.environ["SCARP_SOURCE"]
HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(SOURCE, "python/qgis"))

from scarp_qgis import forms, program  # noqa: E402

MAPS = ("viewshed", "shadow", "horizon", "skyview", "sunhours", "los", "profile", "contours", "merge")


@pytest.fixture(scope="module")
def scarp():
    path = os.environ.get("SCARP", "")
    if not os.access(path, os.X_OK):
        pytest.skip("this build has no command line")
    return path


@pytest.fixture(scope="module")
def declared(scarp):
    return program.subcommands(scarp)


def test_forms_offer_every_option_that_terrain_has(declared):
    for name in set(MAPS) & set(declared):
        options = declared[name]["options"]
        offered = {one["name"] for form in forms.forms_of(declared[name]) for one in form.options}
        for one in options:
            assert (one["name"] in offered) == (one["name"] not in forms.LEFT_OUT and "terrain" in one["inputs"]), one
            if one["name"] in offered:
                assert one["help"] in forms.hint(one) and one["restrictions"] in forms.hint(one)


def test_maps_and_places_are_forms_of_their_own(declared):
    maps, places = forms.forms_of(declared["horizon"])
    of_maps, of_places = ({one["name"] for one in form.options} for form in (maps, places))
    assert "--part" in of_maps - of_places and "--points" in of_places - of_maps and "--labels" in of_places - of_maps
    assert maps.output_files[0] == "tif" and places.output_files[0] == "csv"


def test_options_have_the_field_of_their_values(declared):
    kinds = {
        f"{name} {one['name']}": forms.kind_of(one)
        for name in MAPS
        if name in declared
        for one in declared[name]["options"]
    }
    for option, kind in {
        "viewshed IN": "raster",
        "merge PART": "rasters",
        "viewshed --observer": "point",
        "viewshed --observers": "vector",
        "viewshed --draw": "vectors",
        "viewshed --ground": "raster",
        "viewshed --mode": "choice",
        "viewshed --max-distance": "number",
        "viewshed --threads": "integer",
        "viewshed --crop": "flag",
        "viewshed --scratch": "folder",
        "skyview --measure": "choices",
        "shadow --sun": "text",
        "profile --ray": "text",
    }.items():
        assert kinds[option] == kind, option


@pytest.mark.parametrize(
    "line, percent",
    [
        ("shadow 0", 0),
        ("sky view 0...10...20.", 22.5),
        ("viewshed 0...10..", 15),
        ("viewshed 0...10...20...30...40...50...60...70...80...90...100", 100),
        ("note: cells of 10 x 20", None),
        ("scarp: error: dem.tif: is empty", None),
        ("out.tif: 400 x 300 pixels, 3.87", None),
    ],
)
def test_progress_is_read_from_the_line_of_a_terminal(line, percent):
    assert program.percent_of(line) == percent


def test_one_line_says_that_the_program_is_missing(tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(program.ProgramError, match="^the program 'scarp' is not installed .*Options"):
        program.find_program()
    with pytest.raises(program.ProgramError, match="^'/no/scarp' is not a program"):
        program.find_program("/no/scarp")
    with pytest.raises(program.ProgramError, match="does not describe its options"):
        program.subcommands(sys.executable)


def test_the_archive_is_one_folder_that_everybody_can_read(tmp_path):
    for name in "a.zip", "b.zip":
        subprocess.run([sys.executable, os.path.join(SOURCE, "python/qgis/pack.py"), tmp_path / name], check=True)
    assert (tmp_path / "a.zip").read_bytes() == (tmp_path / "b.zip").read_bytes()
    with zipfile.ZipFile(tmp_path / "a.zip") as archive:
        for entry in archive.infolist():
            assert entry.filename.startswith("scarp_qgis/") and entry.external_attr >> 16 == 0o644
        with open(os.path.join(SOURCE, "CMakeLists.txt"), encoding="utf-8") as file:
            version = file.read().partition("project(scarp VERSION ")[2].split()[0]
        assert f"version={version}\n" in archive.read("scarp_qgis/metadata.txt").decode()


@pytest.fixture(scope="module")
def plugins(tmp_path_factory):
    """The packed plugin, unpacked as QGIS does it."""
    if not shutil.which("qgis_process") or not importlib.util.find_spec("qgis"):
        pytest.skip("needs QGIS (Debian: qgis python3-qgis)")
    folder = tmp_path_factory.mktemp("plugins")
    packed = folder / "scarp_qgis.zip"
    subprocess.run([sys.executable, os.path.join(SOURCE, "python/qgis/pack.py"), packed], check=True)
    with zipfile.ZipFile(packed) as archive:
        archive.extractall(folder)
    return folder


def environment(folder, scarp):
    """Of a QGIS that has settings of its own, and finds the program."""
    path = [os.path.dirname(os.path.abspath(scarp))] if scarp else []
    return {
        **{key: value for key, value in os.environ.items() if key != "PYTHONPATH"},
        "HOME": str(folder),
        "XDG_RUNTIME_DIR": str(folder),
        "QT_QPA_PLATFORM": "offscreen",
        "QGIS_PLUGINPATH": str(folder / "plugins"),
        "PATH": os.pathsep.join([*path, "/usr/bin", "/bin"]),
    }


def write_dem(path, heights):
    gdal, osr = pytest.importorskip("osgeo.gdal"), pytest.importorskip("osgeo.osr")
    data = gdal.GetDriverByName("GTiff").Create(str(path), heights.shape[1], heights.shape[0], 1, gdal.GDT_Float32)
    system = osr.SpatialReference()
    system.ImportFromEPSG(32633)
    data.SetProjection(system.ExportToWkt())
    data.SetGeoTransform((500000, 30, 0, 5000000, 0, -30))
    data.GetRasterBand(1).WriteArray(heights)


@pytest.fixture(scope="module")
def work(tmp_path_factory, scarp):
    from conftest import hills

    folder = tmp_path_factory.mktemp("qgis")
    write_dem(folder / "dem.tif", hills(100, 120))
    write_dem(folder / "large.tif", np.tile(hills(500, 500), (4, 4)))
    (folder / "towers.csv").write_text("x,y,z\n501000,4998500,20\n502000,4998000,10\n")
    return folder


# Parameters of QGIS, and the words of the command line that write the same bytes.
CASES = [
    (
        "viewshed",
        {"OBSERVER": "501000,4998500", "OBSERVER_HEIGHT": 20, "MODE": "angle", "MAX_DISTANCE": 1500.5},
        ["--observer=501000,4998500", "--observer-height=20", "--mode=angle", "--max-distance=1500.5"],
        "tif",
    ),
    ("viewshed", {"OBSERVERS": "towers.csv", "MODE": "count"}, ["--observers=towers.csv", "--mode=count"], "tif"),
    ("viewshed", {"OBSERVER": "501000,4998500"}, ["--observer=501000,4998500"], "tif"),
    ("shadow", {"SUN": "135,20\n200,9;300,10"}, ["--sun=135,20", "--sun=200,9", "--sun=300,10"], "tif"),
    ("horizon", {"AZIMUTHS": 4, "CLAMP": True}, ["--azimuths=4", "--clamp"], "tif"),
    ("horizonatpoints", {"AT": "501000,4998500", "AZIMUTHS": 8}, ["--at=501000,4998500", "--azimuths=8"], "csv"),
    (
        "skyview",
        {"MEASURE": ["sky-view-factor", "positive-openness"], "AZIMUTHS": 8},
        ["--measure=sky-view-factor", "--measure=positive-openness", "--azimuths=8"],
        "tif",
    ),
    ("sunhours", {"DATE": "2026-06-21", "STEP": 120}, ["--date=2026-06-21", "--step=120"], "tif"),
    (
        "los",
        {"FROM": "501000,4998500", "TO": "502000,4998000", "PARTS": True},
        ["--from=501000,4998500", "--to=502000,4998000", "--parts"],
        "geojson",
    ),
    (
        "profile",
        {"FROM": "501000,4998500", "TO": "502000,4998000"},
        ["--from=501000,4998500", "--to=502000,4998000"],
        "csv",
    ),
    ("contours", {"INTERVAL": 20}, ["--interval=20"], "geojson"),
    ("shadow", {"SUN": "135,20", "PART": "1/2"}, ["--sun=135,20", "--part=1/2"], "tif"),
    ("shadow", {"SUN": "135,20", "PART": "2/2"}, ["--sun=135,20", "--part=2/2"], "tif"),
]
WRONG = [
    ("shadow", {}, "no sun: give --sun AZIMUTH,ALTITUDE or --time TIME"),
    ("viewshed", {"OBSERVER": "1,2"}, "is outside"),
    ("viewshed", {"OBSERVERS": "gone.csv"}, "Could not load source layer for OBSERVERS: gone.csv not found"),
    ("sunhours", {"DATE": "today"}, "--date 'today'"),
]


@pytest.fixture(scope="module")
def answer(plugins, work, scarp):
    """What one session of QGIS has done."""
    runs = [[n, {"INPUT": "dem.tif", **p, "OUTPUT": f"q{i}.{e}"}] for i, (n, p, _, e) in enumerate(CASES)]
    parts = [f"q{i}.tif" for i in (len(CASES) - 2, len(CASES) - 1)]
    runs.append(["merge", {"INPUT": parts, "OUTPUT": "merged.tif"}])
    runs += [[n, {"INPUT": "dem.tif", **p, "OUTPUT": "wrong.tif"}] for n, p, _ in WRONG]
    runs.append(["shadow", {"INPUT": "gone.tif", "SUN": "135,20", "OUTPUT": "wrong.tif"}])
    long = ["skyview", {"INPUT": "large.tif", "AZIMUTHS": 3600, "OUTPUT": "never.tif"}]
    styles = [[f"q{i}.{e}", f"q{i}.png"] for i, (n, _, _, e) in enumerate(CASES) if e != "csv"]
    task = {"runs": runs, "cancel": [[*long, 0.3], [*long, None]], "styles": styles}
    (work / "task.json").write_text(json.dumps(task))
    done = subprocess.run(
        [sys.executable, os.path.join(HERE, "qgis_script.py"), plugins, "task.json", "answer.json"],
        cwd=work,
        env=environment(work, scarp),
        capture_output=True,
        text=True,
    )
    assert (work / "answer.json").exists(), done.stderr
    return json.loads((work / "answer.json").read_text())


def test_algorithms_are_those_of_the_program(answer, declared):
    assert answer["warning"] == ""
    offered = {form.name: form for name in MAPS if name in declared for form in forms.forms_of(declared[name])}
    assert set(answer["algorithms"]) == set(offered)
    for name, form in offered.items():
        assert answer["algorithms"][name] == {forms.parameter_name(o): forms.hint(o) for o in form.options}
    assert answer["layers"]["viewshed"] == "Viewshed" and answer["layers"]["horizonatpoints"] == "Horizon at points"


@pytest.mark.parametrize("index", range(len(CASES)))
def test_files_are_those_of_the_command_line(answer, work, scarp, index):
    name, _, words, extension = CASES[index]
    assert answer["runs"][index] == {"OUTPUT": f"q{index}.{extension}"}
    command = [scarp, name.replace("atpoints", ""), "dem.tif", *words, "-o", f"c{index}.{extension}"]
    subprocess.run(command, cwd=work, check=True, capture_output=True)
    ours, theirs = ((work / f"{who}{index}.{extension}").read_bytes() for who in "qc")
    # GDAL writes the name of the file into GeoJSON.
    assert ours.replace(b'"name": "q', b'"name": "c') == theirs


def test_parts_are_merged(answer, work, scarp):
    assert answer["runs"][len(CASES)] == {"OUTPUT": "merged.tif"}
    subprocess.run([scarp, "shadow", "dem.tif", "--sun=135,20", "-o", "whole.tif"], cwd=work, check=True)
    gdal = pytest.importorskip("osgeo.gdal")
    merged, whole = (gdal.Open(str(work / name)).ReadAsArray() for name in ("merged.tif", "whole.tif"))
    assert (merged == whole).all() and set(np.unique(whole)) == {0, 1, 2}


def test_wrong_input_is_one_line(answer, work):
    errors = answer["runs"][len(CASES) + 1 :]
    for (name, parameters, words), error in zip(WRONG, errors):
        # QGIS reports missing layers in two lines of its own.
        error = str(error).replace("Unable to execute algorithm\n", "")
        assert words in error and "\n" not in error, (name, parameters, error)
    assert "Could not load source layer for INPUT: gone.tif not found" in errors[-1]
    assert not (work / "wrong.tif").exists()


def test_cancelling_stops_the_program_at_once(answer, work):
    early, late = answer["cancel"]
    assert early[1] == {} and late[1] == {}
    assert early[2] < 0.5 and late[2] < 0.5
    assert late[0][-1] > 0
    assert not [name for name in os.listdir(work) if "never" in name]


def test_results_are_styled(answer):
    names = [f"{case[0]}{i}" for i, case in enumerate(CASES) if case[3] != "csv"]
    styles = dict(zip(names, answer["styles"]))
    assert styles["viewshed2"] == ["paletted", ["hidden", "visible"]]
    assert styles["shadow3"] == ["paletted", ["lit", "self-shaded", "cast shadow"]]
    for name in "viewshed0", "viewshed1", "horizon4", "skyview6", "sunhours7":
        assert styles[name][0] == "singlebandpseudocolor", name
    assert styles["los8"] == ["categorizedSymbol", ["visible", "blocked"]]
    assert styles["contours10"][0] == "singleSymbol"


def qgis_process(folder, scarp, *words):
    # The wrapper of Debian 12 passes an option that the program does not know.
    name = "qgis_process.bin" if shutil.which("qgis_process.bin") else "qgis_process"
    return subprocess.run(
        [name, *words], cwd=folder, env=environment(folder, scarp), capture_output=True, text=True, errors="replace"
    )


def test_qgis_process_runs_it(plugins, work, scarp):
    home = work / "home"
    shutil.copytree(plugins, home / "plugins")
    home.chmod(0o700)
    assert qgis_process(home, scarp, "plugins", "enable", "scarp_qgis").returncode == 0
    words = ["run", "scarp:shadow", "--", f"INPUT={work}/dem.tif", "SUN=135,20", f"OUTPUT={work}/process.tif"]
    done = qgis_process(home, scarp, *words)
    assert done.returncode == 0, done.stderr
    subprocess.run([scarp, "shadow", f"{work}/dem.tif", "--sun=135,20", "-o", work / "line.tif"], check=True)
    assert (work / "process.tif").read_bytes() == (work / "line.tif").read_bytes()
    # Without the program.
    done = qgis_process(home, "", *words)
    lines = [line for line in done.stderr.splitlines() if line.startswith("scarp: ")]
    assert done.returncode != 0 and len(lines) == 1 and "the program 'scarp' is not installed" in lines[0]

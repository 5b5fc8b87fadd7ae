# SPDX-License-Identifier: MIT
"""Forms: the options of a subcommand that one algorithm offers, and what each of them means to QGIS.

Everything comes from the declarations of the program. A subcommand that maps a raster or, with --at or --points, makes a
table of places becomes two forms.
"""

import re

#: Extensions of maps and of layers, the default first.
RASTERS = ("tif", "tiff", "img", "asc")
VECTORS = ("geojson", "gpkg", "shp", "fgb", "csv")

#: Options without a meaning in QGIS, and why.
LEFT_OUT = {
    "--coords": "points are in the coordinate system of the layer",
    "--dry-run": "it writes no output",
    "--layer": "the layer that was chosen",
    "--quiet": "the log shows notes, the bar progress",
}

# With these, a subcommand computes no map.
_PLACES = ("--at", "--points")


class Form:
    """A subcommand with the options that one algorithm offers.

    Attributes: `command` (its declaration), `options` (likewise), `name`, `title`, `output` (option of the output).
    """

    def __init__(self, command, options, places=False):
        self.command = command
        self.options = [one for one in options if one["name"] not in LEFT_OUT and "terrain" in one["inputs"]]
        self.name = command["name"] + ("atpoints" if places else "")
        word = command["name"]
        self.title = (word.upper() if len(word) <= 3 else word.capitalize()) + (" at points" if places else "")
        self.output = next(one for one in self.options if one["name"] == "--output")
        # A map is neither a table nor a drawing.
        files = self.output["files"]
        if any(one["name"] in _PLACES for one in command["options"]):
            files = [one for one in files if (one in RASTERS) != places]
        self.output_files = files

    def help(self):
        """The description as HTML: summary, notes and examples of the command line."""
        parts = [f"<p>{_html(self.command['summary'])}.</p>"]
        if self.command["notes"]:
            parts.append(f"<pre>{_html(self.command['notes'])}</pre>")
        lines = "\n".join(self.command["examples"])
        return "".join(parts) + f"<p>The same on the command line:</p><pre>{_html(lines)}</pre>"


def forms_of(command):
    """Returns the forms of a subcommand: one, or a map and places."""
    options = command["options"]
    names = {one["name"] for one in options}
    if not names.issuperset(_PLACES):
        return [Form(command, options)]
    of_places = re.compile(r"without (--at|--points)\b")
    maps = [o for o in options if o["name"] not in _PLACES and not of_places.search(o["restrictions"])]
    places = [o for o in options if not set(_PLACES) <= set(o["excludes"])]
    return [Form(command, maps), Form(command, places, True)]


def parameter_name(option):
    """Returns the name in QGIS: INPUT, OUTPUT, MAX_DISTANCE."""
    return "INPUT" if option["positional"] else option["name"].lstrip("-").replace("-", "_").upper()


def label(option):
    """Returns the text beside the field: "Maximum distance of targets in metres (unlimited)"."""
    text = option["help"].split("; ")[0]
    default = f" ({option['default']})" if option["default"] else ""
    name = "" if option["positional"] else f" [{option['name']}]"
    return text[0].upper() + text[1:] + default + name


def hint(option):
    """Returns the tooltip of the field: the option, what it means, and when it has an effect."""
    text = option["help"]
    if option["repeats"] and kind_of(option) == "text":
        text += "; one per line"
    rules = f". Restrictions: {option['restrictions']}" if option["restrictions"] else ""
    return f"{option['synopsis']}: {text}{rules}"


def kind_of(option):
    """Returns the kind of field.

    raster, rasters, vector, vectors, file, folder; flag, integer, number, choice, choices, point, text.
    """
    files = set(option["files"])
    many = "s" if option["repeats"] else ""
    if option["positional"]:
        # Tiles of one model are one layer in QGIS: a virtual raster.
        return "raster" if option["name"] == "IN" else "rasters"
    if option["kind"] != "text":
        return option["kind"]
    if "*" in files:
        return "raster" + many
    if files & set(VECTORS):
        return "vector" + many if files - {"csv"} else "file"
    if files:
        return "file"
    if option["synopsis"].endswith(" DIR"):
        return "folder"
    if option["choices"] and option["closed"]:
        return "choice" + many
    return "point" if " X,Y" in option["synopsis"] and "Z" not in option["synopsis"] else "text"


def _html(text):
    return text.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")

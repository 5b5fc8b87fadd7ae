# SPDX-License-Identifier: MIT
"""One algorithm: the fields of a form, the words of the command line that they stand for, and its run."""

import os

from qgis.core import (
    QgsProcessing,
    QgsProcessingAlgorithm,
    QgsProcessingException,
    QgsProcessingParameterBoolean,
    QgsProcessingParameterDefinition,
    QgsProcessingParameterEnum,
    QgsProcessingParameterFeatureSource,
    QgsProcessingParameterFile,
    QgsProcessingParameterFileDestination,
    QgsProcessingParameterMultipleLayers,
    QgsProcessingParameterNumber,
    QgsProcessingParameterPoint,
    QgsProcessingParameterRasterDestination,
    QgsProcessingParameterRasterLayer,
    QgsProcessingParameterString,
    QgsProcessingParameterVectorDestination,
    QgsProcessingUtils,
)

from .forms import RASTERS, VECTORS, hint, kind_of, label, parameter_name
from .program import ProgramError, run
from .styles import Styler


class Algorithm(QgsProcessingAlgorithm):
    """A map of the program."""

    def __init__(self, program, form):
        super().__init__()
        self._program, self._form = program, form
        self._words, self._outputs = [], {}
        self._styler = None  # QGIS keeps no reference

    def createInstance(self):
        return Algorithm(self._program, self._form)

    def name(self):
        return self._form.name

    def displayName(self):
        return self._form.title

    def shortDescription(self):
        return self._form.command["summary"]

    def shortHelpString(self):
        return self._form.help()

    def tags(self):
        return ["scarp", "terrain", *self._form.command["summary"].lower().split()]

    def initAlgorithm(self, configuration=None):
        # As QGIS orders fields: what is read first, the result last.
        for option in sorted(self._form.options, key=lambda one: one["writes"] - one["positional"]):
            self._add(option)

    def _add(self, option):
        if option["writes"]:
            field = self._destination(option)
        else:
            field = _field(option)
            if not option["required"]:
                field.setFlags(field.flags() | QgsProcessingParameterDefinition.FlagOptional)
        if not option["common"] and not option["required"] and not option["positional"]:
            field.setFlags(field.flags() | QgsProcessingParameterDefinition.FlagAdvanced)
        field.setHelp(hint(option))
        self.addParameter(field)

    def _destination(self, option):
        name, text = parameter_name(option), label(option)
        if option["name"] != "--output":
            filters = ";;".join(f"{one.upper()} (*.{one})" for one in option["files"])
            return QgsProcessingParameterFileDestination(name, text, filters, None, True, False)
        text = self._form.title  # the name of the layer, too
        files = self._form.output_files
        if set(files) & set(RASTERS):
            return QgsProcessingParameterRasterDestination(name, text)
        if set(files) & (set(VECTORS) - {"csv"}):
            return QgsProcessingParameterVectorDestination(name, text)
        return QgsProcessingParameterFileDestination(name, text, ";;".join(f"{one.upper()} (*.{one})" for one in files))

    def prepareAlgorithm(self, parameters, context, feedback):
        # In the thread of the layers.
        command = self._form.command["name"]
        self._words, self._outputs = [self._program, command], {}
        inputs = []
        for option in self._form.options:
            values = self._values(option, parameters, context, feedback)
            if option["positional"]:
                inputs += values
            else:
                self._words += values
        self._words += inputs
        return True

    def processAlgorithm(self, parameters, context, feedback):
        feedback.pushCommandInfo(" ".join(map(_quoted, self._words)))
        try:
            finished = run(self._words, feedback)
        except ProgramError as error:
            raise QgsProcessingException(str(error)) from None
        return dict(self._outputs) if finished else {}

    def postProcessAlgorithm(self, context, feedback):
        output = self._outputs.get("OUTPUT", "")
        if context.willLoadLayerOnCompletion(output):
            self._styler = Styler()
            context.layerToLoadOnCompletionDetails(output).setPostProcessor(self._styler)
        return {}

    def _values(self, option, parameters, context, feedback):
        """Returns the words of one option; none for an empty field."""
        name, kind, key = parameter_name(option), kind_of(option), option["name"]
        if option["writes"]:
            return self._output_words(option, parameters, context)
        given = parameters.get(name)
        if given is None or given == "" or given == []:
            return []
        if kind == "flag":
            return [key] if self.parameterAsBoolean(parameters, name, context) else []
        if kind == "raster":
            texts = [_file_of(self.parameterAsRasterLayer(parameters, name, context), name, given)]
        elif kind == "rasters":
            texts = [_file_of(one, name, given) for one in self.parameterAsLayerList(parameters, name, context)]
        elif kind == "vector":
            return self._vector_words(option, parameters, context, feedback)
        elif kind == "vectors":
            texts = [
                QgsProcessingUtils.convertToCompatibleFormat(
                    one, False, name.lower(), option["files"], "gpkg", context, feedback
                )
                for one in self.parameterAsLayerList(parameters, name, context)
            ]
        elif kind == "number":
            texts = [_number(self.parameterAsDouble(parameters, name, context))]
        elif kind == "integer":
            texts = [str(self.parameterAsInt(parameters, name, context))]
        elif kind == "choice":
            texts = [self.parameterAsEnumString(parameters, name, context)]
        elif kind == "choices":
            texts = self.parameterAsEnumStrings(parameters, name, context)
        elif kind == "point":
            texts = [self._point(name, parameters, context)]
        else:
            text = self.parameterAsString(parameters, name, context)
            texts = text.replace(";", "\n").split("\n") if option["repeats"] else [text]
            texts = [one.strip() for one in texts if one.strip()]
        # In one word, so that values may begin with a hyphen.
        return texts if option["positional"] else [f"{key}={text}" for text in texts]

    def _output_words(self, option, parameters, context):
        name = parameter_name(option)
        if option["name"] == "--output" and not isinstance(
            self.parameterDefinition(name), QgsProcessingParameterFileDestination
        ):
            path = self.parameterAsOutputLayer(parameters, name, context)
        else:
            path = self.parameterAsFileOutput(parameters, name, context)
        if not path:
            return []
        self._outputs[name] = path
        return [f"{option['name']}={path}"]

    def _vector_words(self, option, parameters, context, feedback):
        """Returns the file of a layer and, where the program has an option for it, the layer in it."""
        name = parameter_name(option)
        path, layer = self.parameterAsCompatibleSourceLayerPathAndLayerName(
            parameters, name, context, option["files"], "gpkg", feedback
        )
        if not path:
            raise QgsProcessingException(f"{name}: '{parameters[name]}' is not a layer")
        words = [f"{option['name']}={path}"]
        # --layer goes with the one file of places that a subcommand has.
        offered = next((one for one in self._form.command["options"] if one["name"] == "--layer"), None)
        if layer and offered and f"{option['name']} FILE" in offered["restrictions"]:
            words.append(f"--layer={layer}")
        return words

    def _point(self, name, parameters, context):
        ground = self.parameterAsRasterLayer(parameters, "INPUT", context)
        if ground is None:
            raise QgsProcessingException(f"INPUT: '{parameters.get('INPUT')}' is not a raster layer")
        point = self.parameterAsPoint(parameters, name, context, ground.crs())
        return f"{_number(point.x())},{_number(point.y())}"


def _field(option):
    """Returns the field of an option that is read."""
    name, text, kind = parameter_name(option), label(option), kind_of(option)
    if kind == "raster":
        return QgsProcessingParameterRasterLayer(name, text)
    if kind in ("rasters", "vectors"):
        of = QgsProcessing.TypeRaster if kind == "rasters" else QgsProcessing.TypeVector
        return QgsProcessingParameterMultipleLayers(name, text, of)
    if kind == "vector":
        return QgsProcessingParameterFeatureSource(name, text, [QgsProcessing.TypeVector])
    if kind == "folder":
        return QgsProcessingParameterFile(name, text, QgsProcessingParameterFile.Folder)
    if kind == "file":
        return QgsProcessingParameterFile(name, text)
    if kind == "flag":
        return QgsProcessingParameterBoolean(name, text, False)
    if kind in ("number", "integer"):
        of = QgsProcessingParameterNumber.Double if kind == "number" else QgsProcessingParameterNumber.Integer
        limits = {"least": "minValue", "most": "maxValue"}
        bounds = {limits[key]: value for key, value in option["range"].items() if key in limits}
        return QgsProcessingParameterNumber(name, text, of, None, True, **bounds)
    if kind in ("choice", "choices"):
        return QgsProcessingParameterEnum(
            name, text, option["choices"], kind == "choices", None, True, usesStaticStrings=True
        )
    if kind == "point":
        return QgsProcessingParameterPoint(name, text)
    return QgsProcessingParameterString(name, text, None, option["repeats"])


def _file_of(layer, name, given):
    """Returns the file of a raster layer. Throws QgsProcessingException."""
    if layer is None:
        raise QgsProcessingException(f"{name}: '{given}' is not a raster layer")
    if layer.dataProvider() is None or layer.dataProvider().name() != "gdal":
        raise QgsProcessingException(f"{name}: layer '{layer.name()}' is not a file (export it as GeoTIFF)")
    source = layer.source()
    return os.path.normpath(source) if os.path.exists(source) else source


def _number(value):
    """Returns the shortest text of a number that reads as the same."""
    text = repr(float(value))
    return text[:-2] if text.endswith(".0") else text


def _quoted(word):
    return word if word.replace("=", "").replace("/", "").replace("-", "").isalnum() else f"'{word}'"

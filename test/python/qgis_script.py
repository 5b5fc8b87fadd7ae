# SPDX-License-Identifier: MIT
"""Runs the plugin of QGIS in an application without a window: qgis_script.py PLUGINS TASK.json ANSWER.json.

The task is {"runs": [[algorithm, parameters]], "cancel": [[algorithm, parameters, seconds]], "styles": [[file, picture]]}.
Seconds of null: cancelled at the first progress.
"""

import json
import sys
import threading
import time

plugins, task, answer = sys.argv[1:]
sys.path[:0] = [plugins, "/usr/share/qgis/python/plugins"]

from qgis.core import (  # noqa: E402
    QgsApplication,
    QgsMapRendererParallelJob,
    QgsMapSettings,
    QgsProcessingContext,
    QgsProcessingException,
    QgsProcessingFeedback,
    QgsRasterLayer,
    QgsVectorLayer,
)
from qgis.PyQt.QtCore import QSize  # noqa: E402
from qgis.PyQt.QtGui import QColor  # noqa: E402

application = QgsApplication([], False)
application.initQgis()

import processing  # noqa: E402
from processing.core.Processing import Processing  # noqa: E402

Processing.initialize()
from scarp_qgis import classFactory  # noqa: E402

plugin = classFactory(None)
plugin.initProcessing()
provider = QgsApplication.processingRegistry().providerById("scarp")


def ran(algorithm, parameters):
    """The outputs, or the text of the error."""
    try:
        return processing.run(f"scarp:{algorithm}", parameters)
    except QgsProcessingException as error:
        return str(error)


def cancelled(algorithm, parameters, seconds):
    """The progress that was shown, what the algorithm returned, and seconds until it did."""
    feedback, shown, at = QgsProcessingFeedback(), [], []

    def cancel():
        at.append(time.monotonic())
        feedback.cancel()

    def show(percent):
        shown.append(percent)
        if seconds is None and percent > 0 and not at:
            cancel()

    feedback.progressChanged.connect(show)
    if seconds is not None:
        threading.Timer(seconds, cancel).start()
    algorithm = QgsApplication.processingRegistry().algorithmById(f"scarp:{algorithm}").create()
    results, _ = algorithm.run(parameters, QgsProcessingContext(), feedback)
    return shown, results, time.monotonic() - at[0]


def drawn(file, picture):
    """Styles a layer, draws it, and returns the type of its renderer and the texts of its legend."""
    from scarp_qgis.styles import style

    layer = QgsVectorLayer(file, "lines") if file.endswith(".geojson") else QgsRasterLayer(file, "map")
    style(layer)
    settings = QgsMapSettings()
    settings.setLayers([layer])
    settings.setBackgroundColor(QColor("white"))
    settings.setOutputSize(QSize(480, 400))
    settings.setDestinationCrs(layer.crs())
    settings.setExtent(layer.extent())
    job = QgsMapRendererParallelJob(settings)
    job.start()
    job.waitForFinished()
    job.renderedImage().save(picture)
    renderer = layer.renderer()
    if file.endswith(".geojson"):
        texts = [item.label() for item in renderer.legendSymbolItems()]
    else:
        texts = [text for text, _ in renderer.legendSymbologyItems()]
    return renderer.type(), texts


with open(task, encoding="utf-8") as file:
    asked = json.load(file)
found = {
    "warning": provider.warningMessage(),
    "algorithms": {
        algorithm.name(): {one.name(): one.help() for one in algorithm.parameterDefinitions()}
        for algorithm in provider.algorithms()
    },
    "layers": {one.name(): one.parameterDefinition("OUTPUT").description() for one in provider.algorithms()},
    "runs": [ran(*one) for one in asked.get("runs", [])],
    "cancel": [cancelled(*one) for one in asked.get("cancel", [])],
    "styles": [drawn(*one) for one in asked.get("styles", [])],
}
with open(answer, "w", encoding="utf-8") as file:
    json.dump(found, file)

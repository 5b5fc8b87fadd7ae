# SPDX-License-Identifier: MIT
"""The provider: one algorithm per map that the installed program offers."""

import sys

from processing.core.ProcessingConfig import ProcessingConfig, Setting
from qgis import utils
from qgis.core import Qgis, QgsMessageLog, QgsProcessingProvider

from .algorithm import Algorithm
from .forms import RASTERS, VECTORS, forms_of
from .program import SETTING, ProgramError, find_program, subcommands

#: The subcommands that answer questions about rasters.
MAPS = ("viewshed", "shadow", "horizon", "skyview", "sunhours", "los", "profile", "contours", "merge")


class Provider(QgsProcessingProvider):
    """Algorithms scarp:viewshed, scarp:shadow and so on."""

    def __init__(self):
        super().__init__()
        self._problem = ""

    def id(self):
        return "scarp"

    def name(self):
        return "Scarp"

    def longName(self):
        return "Scarp: exact maps of terrain"

    def load(self):
        ProcessingConfig.settingIcons["Scarp"] = self.icon()
        ProcessingConfig.addSetting(
            Setting("Scarp", SETTING, "Program scarp (empty: from PATH)", "", valuetype=Setting.FILE)
        )
        ProcessingConfig.readSettings()
        self.refreshAlgorithms()
        return True

    def unload(self):
        ProcessingConfig.removeSetting(SETTING)

    def loadAlgorithms(self):
        self._problem = ""
        try:
            program = find_program(ProcessingConfig.getSetting(SETTING) or "")
            known = subcommands(program)
        except ProgramError as error:
            self._problem = str(error)
            QgsMessageLog.logMessage(self._problem, "Scarp", Qgis.Warning)
            if utils.iface is None:  # qgis_process shows no log
                print(f"scarp: {self._problem}", file=sys.stderr)
            return
        for name in MAPS:
            if name in known:
                for form in forms_of(known[name]):
                    self.addAlgorithm(Algorithm(program, form))

    def warningMessage(self):
        return self._problem

    def supportedOutputRasterLayerExtensions(self):
        return list(RASTERS)

    def supportedOutputVectorLayerExtensions(self):
        return list(VECTORS)

    def defaultVectorFileExtension(self, hasGeometry=True):  # noqa: N803
        return VECTORS[0]

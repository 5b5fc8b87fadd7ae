# SPDX-License-Identifier: MIT
"""Registers the provider."""

from qgis.core import QgsApplication

from .provider import Provider


class Plugin:
    """What QGIS calls when the plugin is switched on and off."""

    def __init__(self):
        self._provider = None

    def initProcessing(self):
        """For qgis_process, which has no window."""
        self._provider = Provider()
        QgsApplication.processingRegistry().addProvider(self._provider)

    def initGui(self):
        self.initProcessing()

    def unload(self):
        if self._provider is not None:
            QgsApplication.processingRegistry().removeProvider(self._provider)
            self._provider = None

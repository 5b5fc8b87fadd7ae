# SPDX-License-Identifier: MIT
"""Plugin of QGIS: the maps of the command line `scarp` as algorithms of Processing."""


def classFactory(iface):  # noqa: N802, the name that QGIS calls
    """Returns the plugin."""
    from .plugin import Plugin

    return Plugin()

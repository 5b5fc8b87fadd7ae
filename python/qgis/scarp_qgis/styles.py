# SPDX-License-Identifier: MIT
"""Styles of results, from what the files say of themselves, as in the pictures of --preview.

Bands of codes have colours in the file and names in its metadata (LEGEND); other bands get a ramp: counts without the
pixels that nothing was counted at, other numbers between their quantiles of 1 % and 99 %, in grey if they are shares,
which have no unit. Codes of files with several bands, which hold no colours, are yellow to violet. Lines of sight are
green or red, contours brown.
"""

import re

from osgeo import gdal
from qgis.core import (
    Qgis,
    QgsCategorizedSymbolRenderer,
    QgsColorRampShader,
    QgsGradientColorRamp,
    QgsLineSymbol,
    QgsPalettedRasterRenderer,
    QgsProcessingLayerPostProcessorInterface,
    QgsRasterBandStats,
    QgsRasterShader,
    QgsRasterTransparency,
    QgsRendererCategory,
    QgsSingleBandPseudoColorRenderer,
    QgsSingleSymbolRenderer,
    QgsStyle,
)
from qgis.PyQt.QtGui import QColor

VISIBLE, BLOCKED, CONTOUR = "#2c963c", "#c0392b", "#8a5a2b"


class Styler(QgsProcessingLayerPostProcessorInterface):
    """Styles the layer of a result when it is loaded."""

    def postProcessLayer(self, layer, context, feedback):
        style(layer)


def style(layer):
    """Gives a layer that scarp has written its colours."""
    if hasattr(layer, "bandCount"):
        _style_raster(layer)
    else:
        _style_lines(layer)
    layer.triggerRepaint()


def _style_raster(layer):
    band = 1
    provider = layer.dataProvider()
    codes, unit = _texts_of(layer, band)
    if codes:
        # Only files of one band can hold colours.
        colours = {
            int(one.value): one.color
            for one in QgsPalettedRasterRenderer.colorTableToClassData(provider.colorTable(band))
        }
        shown = sorted(code for code in codes if code != provider.sourceNoDataValue(band))
        ramp = QgsStyle.defaultStyle().colorRamp("Viridis")
        for i, code in enumerate(shown):
            colours.setdefault(code, ramp.color(1 - i / max(1, len(shown) - 1)))
        classes = [QgsPalettedRasterRenderer.Class(code, colours[code], codes[code]) for code in shown]
        layer.setRenderer(QgsPalettedRasterRenderer(provider, band, classes))
        return
    whole = provider.dataType(band) in (Qgis.Byte, Qgis.UInt16) and provider.bandScale(band) == 1
    count, share = whole and not unit, not whole and not unit
    if whole:
        found = provider.bandStatistics(band, QgsRasterBandStats.Min | QgsRasterBandStats.Max)
        low, high = (1.0 if count else found.minimumValue), found.maximumValue
    else:
        low, high = layer.dataProvider().cumulativeCut(band, 0.01, 0.99, sampleSize=250000)
    if not high > low:
        high = low + 1
    ramp = (
        QgsGradientColorRamp(QColor("black"), QColor("white"))
        if share
        else QgsStyle.defaultStyle().colorRamp("Viridis")
    )
    function = QgsColorRampShader(low, high, ramp, QgsColorRampShader.Interpolated)
    function.classifyColorRamp(5)
    shader = QgsRasterShader()
    shader.setRasterShaderFunction(function)
    renderer = QgsSingleBandPseudoColorRenderer(provider, band, shader)
    renderer.setClassificationMin(low)
    renderer.setClassificationMax(high)
    if count:
        clear = QgsRasterTransparency.TransparentSingleValuePixel()
        clear.min = clear.max = 0
        clear.percentTransparent = 100
        transparency = QgsRasterTransparency()
        transparency.setTransparentSingleValuePixelList([clear])
        renderer.setRasterTransparency(transparency)
    layer.setRenderer(renderer)


def _texts_of(layer, band):
    """Returns the names of the codes of a band, none for bands of numbers, and its unit."""
    data = gdal.Open(layer.source())
    if data is None:
        return {}, ""
    legend = data.GetRasterBand(band).GetMetadataItem("LEGEND") or ""
    return {int(code): name for code, name in re.findall(r"(\d+) ([^,]+)", legend)}, data.GetRasterBand(
        band
    ).GetUnitType()


def _style_lines(layer):
    if layer.geometryType() != 1:  # lines
        return

    def line(colour, width):
        return QgsLineSymbol.createSimple({"line_color": colour, "line_width": str(width)})

    if layer.fields().lookupField("visible") >= 0:
        seen = [(True, VISIBLE, "visible"), (False, BLOCKED, "blocked")]
        categories = [QgsRendererCategory(value, line(colour, 0.5), text) for value, colour, text in seen]
        layer.setRenderer(QgsCategorizedSymbolRenderer("visible", categories))
    else:
        layer.setRenderer(QgsSingleSymbolRenderer(line(CONTOUR, 0.2)))

"""The Processing provider "Relevo" of QGIS."""


def classFactory(iface):  # noqa: N802, QGIS calls it
    """@param iface  of QGIS' window; None in qgis_process"""
    from .provider import Plugin

    return Plugin()

"""The algorithms of the QGIS plugin, by PyQGIS."""

import os
import pathlib
import re
import shutil
import sys
import tempfile
import unittest
import zipfile

from support import DEM, PLUGINS, PROGRAM, ROOT, relevo, scratch_environment, skip

_folder = tempfile.TemporaryDirectory()
os.environ.update(scratch_environment(_folder.name))
try:
    import numpy
    from osgeo import gdal
    from qgis.core import (
        QgsApplication,
        QgsCoordinateReferenceSystem,
        QgsFeature,
        QgsField,
        QgsGeometry,
        QgsProcessingContext,
        QgsProcessingException,
        QgsProcessingFeedback,
        QgsProcessingUtils,
        QgsProject,
        QgsRasterLayer,
        QgsVectorLayer,
    )
    from qgis.PyQt.QtCore import QDate, QDateTime, Qt, QTime, QVariant
except ImportError as error:
    skip(f"QGIS is not installed (packages qgis, python3-qgis): {error}")

sys.path[:0] = [str(PLUGINS), "/usr/share/qgis/python/plugins"]
application = QgsApplication([], False)
application.initQgis()
import processing  # noqa: E402
from processing.core.Processing import Processing  # noqa: E402
from processing.core.ProcessingConfig import ProcessingConfig  # noqa: E402

Processing.initialize()
from relevo_provider import library, program  # noqa: E402
from relevo_provider.algorithm import PROGRAM_SETTING, RelevoAlgorithm, find_backend  # noqa: E402
from relevo_provider.backend import RelevoError  # noqa: E402
from relevo_provider.inputs import dem_of, when_of  # noqa: E402
from relevo_provider.pictures import PictureAlgorithm  # noqa: E402
from relevo_provider.provider import Plugin  # noqa: E402
from relevo_provider.ramps import RAMPS  # noqa: E402

plugin = Plugin()
plugin.initProcessing()


class Feedback(QgsProcessingFeedback):
    """Keeps what it hears. Cancels as soon as there is progress if `cancels`."""

    def __init__(self, cancels=False):
        super().__init__(False)
        self.infos, self.warnings, self.shares = [], [], []
        self.progressChanged.connect(self.shares.append)
        if cancels:
            self.progressChanged.connect(self.cancel)

    def pushInfo(self, text):  # noqa: N802
        self.infos.append(text)

    def pushWarning(self, text):  # noqa: N802
        self.warnings.append(text)

    def reportError(self, text, fatal=False):  # noqa: N802
        pass


class Case(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        # QGIS writes statistics next to what it opens.
        self.dem = self.path("dem.tif")
        shutil.copy(DEM, self.dem)
        self.feedback = Feedback()
        self.layers = []
        self.addCleanup(self.layers.clear)

    def path(self, name):
        return str(self.folder / name)

    def run_algorithm(self, word, **parameters):
        return processing.run("relevo:" + word, {"INPUT": self.dem, **parameters}, feedback=self.feedback)

    def loaded(self, path):
        """A layer of a file as QGIS opens it. It is kept, because its parts do not outlive it."""
        self.layers.append(QgsRasterLayer(path, "loaded"))
        return self.layers[-1]

    def shader(self, path):
        return self.loaded(path).renderer().shader().rasterShaderFunction()

    def expect_values(self, made, *words):
        """A raster has the values, the grid, the nodata value, and the names and units of bands that the program writes."""
        expected = self.path("expected.tif")
        relevo(*words, "-o", expected)
        ours, theirs = gdal.Open(made), gdal.Open(expected)
        for describe in (gdal.Dataset.GetGeoTransform, gdal.Dataset.GetProjection):
            self.assertEqual(describe(ours), describe(theirs))
        self.assertEqual(ours.RasterCount, theirs.RasterCount)
        for number in range(1, ours.RasterCount + 1):
            mine, other = ours.GetRasterBand(number), theirs.GetRasterBand(number)
            self.assertEqual(mine.ReadAsArray().tobytes(), other.ReadAsArray().tobytes())
            for describe in (gdal.Band.GetDescription, gdal.Band.GetUnitType, gdal.Band.GetNoDataValue):
                self.assertEqual(str(describe(mine)), str(describe(other)))


class Provider(unittest.TestCase):
    def test_has_its_algorithms(self):
        provider = QgsApplication.processingRegistry().providerById("relevo")
        names = sorted(algorithm.name() for algorithm in provider.algorithms())
        self.assertEqual(names, ["capture", "carpet", "horizon", "map", "shadow", "skyview", "sunhours"])
        self.assertFalse(provider.icon().isNull())
        for algorithm in provider.algorithms():
            self.assertTrue(algorithm.shortHelpString() and algorithm.canExecute()[0], algorithm.name())
            self.assertTrue(all(one.description() for one in algorithm.parameterDefinitions()))

    def test_presets_are_those_of_the_program(self):
        names = [path.stem for path in (ROOT / "data" / "presets").glob("*.json")]
        self.assertEqual(PictureAlgorithm.PRESETS, ["none", *sorted(names)])

    def test_numbers_and_bands_are_those_of_core(self):
        core = ROOT / "core" / "figure"
        options = re.findall(r"Option k(\w+)\{\s*\{([^}]*)\}", (core / "options.h").read_text())
        numbers = {name: [float(number) for number in three.split(",")] for name, three in options}
        registry = QgsApplication.processingRegistry()
        for word, parameter, option, unit in (
            ("sunhours", "STEP", "Step_s", 60), ("sunhours", "LINKE", "Linke", 1), ("sunhours", "ALBEDO", "Albedo", 1),
            ("skyview", "DIRECTIONS", "SkyDirections", 1),
        ):  # fmt: skip
            one = registry.algorithmById("relevo:" + word).parameterDefinition(parameter)
            ours = [unit * number for number in (one.defaultValue(), one.minimum(), one.maximum())]
            self.assertEqual(ours, numbers[option], option)
        bands = registry.algorithmById("relevo:sunhours").parameterDefinition("BANDS").options()
        self.assertEqual(bands, re.findall(r'^    \{"(\w+)", "', (core / "hours.cpp").read_text(), re.MULTILINE))

    def test_says_where_relevo_is_missing(self):
        path = os.environ["PATH"]
        self.addCleanup(os.environ.__setitem__, "PATH", path)
        os.environ["PATH"] = "/"
        if library.find() is not None:
            self.skipTest("the Python package is installed")
        can, why = RelevoAlgorithm.canExecute(
            QgsApplication.processingRegistry().algorithmById("relevo:shadow")
        )
        self.assertFalse(can)
        self.assertIn("Relevo is not installed", why)


    def test_the_setting_goes_before_the_path(self):
        with tempfile.TemporaryDirectory() as folder:
            other = os.path.join(folder, "other")
            os.symlink(PROGRAM, other)
            ProcessingConfig.setSettingValue(PROGRAM_SETTING, other)
            self.addCleanup(ProcessingConfig.setSettingValue, PROGRAM_SETTING, "")
            self.assertIn(f"({other})", find_backend().description())
        with self.assertRaisesRegex(RelevoError, "other: no program; correct it in the settings of Processing"):
            find_backend()


class Rasters(Case):
    def test_hours_have_values_style_and_metadata(self):
        output = self.run_algorithm("sunhours", FROM=QDate(2026, 6, 21), OUTPUT=self.path("hours.tif"))["OUTPUT"]
        self.expect_values(output, "sun", "hours", self.dem, "--date", "2026-06-21")
        self.assertFalse(os.path.exists(output + ".aux.xml"))
        layer, shader = self.loaded(output), self.shader(output)
        colors = [item.color.name()[1:] for item in shader.colorRampItemList()]
        self.assertEqual(colors, [rgb for rgb, _ in RAMPS["sun"]])
        largest = float(gdal.Open(output).ReadAsArray().max())
        self.assertEqual((shader.minimumValue(), shader.maximumValue()), (0, largest))
        self.assertEqual(shader.legendSettings().suffix(), " h")
        layer.loadDefaultMetadata()
        self.assertEqual(layer.metadata().title(), "Hours of direct sun, 2026-06-21")
        self.assertIn("Band 1: sun hours [h]", layer.metadata().abstract())
        self.assertIn("hours that the centre of the sun stands over the terrain", layer.metadata().abstract())

    def test_hours_of_several_days_and_bands(self):
        output = self.run_algorithm(
            "sunhours", FROM="2026-03-01", TO="2026-03-02", BANDS=["first", "global"], LINKE=4, ALBEDO=0.5, STEP=10,
            ZONE="solar", OUTPUT=self.path("hours.tif"),
        )["OUTPUT"]  # fmt: skip
        self.expect_values(output, "sun", "hours", self.dem, "--from", "2026-03-01", "--to", "2026-03-02", "--bands",
                           "first,global", "--linke", 4, "--albedo", 0.5, "--step", 10, "--tz", "solar")  # fmt: skip
        self.assertEqual(self.shader(output).legendSettings().suffix(), " min")
        self.assertIn("time zone solar", self.feedback.infos)

    def test_days_are_a_day_or_a_year(self):
        for days in ({}, {"FROM": "2026-06-21", "YEAR": 2026}, {"TO": "2026-06-21", "YEAR": 2026}):
            with self.assertRaisesRegex(QgsProcessingException, "days: expected either"):
                self.run_algorithm("sunhours", OUTPUT=self.path("hours.tif"), **days)

    def test_a_mask_has_two_classes(self):
        time = QDateTime(QDate(2026, 12, 21), QTime(9, 0))
        output = self.run_algorithm("shadow", TIME=time, OUTPUT=self.path("shadow.tif"))["OUTPUT"]
        self.expect_values(output, "sun", "shadow", self.dem, "--time", "2026-12-21T09:00:00")
        classes = self.loaded(output).renderer().classes()
        self.assertEqual([(one.value, one.label) for one in classes], [(1, "in the sun"), (0, "in the shade")])
        self.assertEqual([one.color.alpha() for one in classes], [0, round(0.62 * 255)])
        self.assertIn("time zone America/New_York of the place; --tz sets another", self.feedback.infos)
        self.assertTrue(any(text.startswith("mountains outside this DEM") for text in self.feedback.warnings))

    def test_a_part_at_an_event(self):
        output = self.run_algorithm(
            "shadow", TIME="2026-12-21T00:00:00", EVENT="sunset-30min", ZONE="+01:00", SOFT=True, OUTPUT=self.path("s.tif"),
            EXTENT="-84.3,-84.2,36.2,36.3 [EPSG:4326]",
        )["OUTPUT"]  # fmt: skip
        self.expect_values(output, "sun", "shadow", self.dem, "--time", "sunset-30min", "--date", "2026-12-21", "--tz",
                           "+01:00", "--soft", "--clip=-84.3,36.2,-84.2,36.3")  # fmt: skip

    def test_sky_views(self):
        output = self.run_algorithm("skyview", DIRECTIONS=8, LEVEL=True, OUTPUT=self.path("sky.tif"))["OUTPUT"]
        self.expect_values(output, "sun", "sky-view", self.dem, "--directions", 8, "--level")
        shader = self.shader(output)
        self.assertEqual((shader.maximumValue(), shader.legendSettings().suffix()), (1, ""))

    def test_a_layer_that_qgis_loads_has_its_title_and_its_style(self):
        context = QgsProcessingContext()
        context.setProject(QgsProject())
        path = self.path("sky.tif")
        context.addLayerToLoadOnCompletion(path, QgsProcessingContext.LayerDetails("Result", context.project(), "OUTPUT"))
        algorithm = QgsApplication.processingRegistry().algorithmById("relevo:skyview")
        algorithm.run({"INPUT": self.dem, "DIRECTIONS": 8, "OUTPUT": path}, context, self.feedback)
        details = context.layerToLoadOnCompletionDetails(path)
        self.assertEqual(details.name, "Sky-view factor")
        layer = QgsProcessingUtils.mapLayerFromString(path, context)
        details.postProcessor().postProcessLayer(layer, context, self.feedback)
        self.assertEqual(layer.renderer().type(), "singlebandpseudocolor")

    def test_cancelling_ends_the_work_without_a_result(self):
        self.feedback = Feedback(cancels=True)
        algorithm = QgsApplication.processingRegistry().algorithmById("relevo:sunhours")
        parameters = {"INPUT": self.dem, "YEAR": 2026, "BANDS": ["hours", "global"], "OUTPUT": self.path("year.tif")}
        results, _ = algorithm.run(parameters, QgsProcessingContext(), self.feedback)
        self.assertEqual(results, {})
        self.assertFalse(os.path.exists(self.path("year.tif")))


class Inputs(Case):
    def test_errors_are_the_sentences_of_relevo(self):
        for parameters, expected in (
            ({"ZONE": "Nowhere/X"}, "^time zone: Nowhere/X: no such time zone, expected a name of the IANA database"),
            ({"OUTPUT": "/no/folder/a.tif"}, "/no/folder"),
        ):
            with self.assertRaisesRegex(QgsProcessingException, expected):
                self.run_algorithm("shadow", TIME="2026-06-21T12:00:00", **{"OUTPUT": self.path("a.tif"), **parameters})

    def test_layers_that_are_no_file_are_refused(self):
        memory = gdal.GetDriverByName("GTiff").CreateCopy("/vsimem/dem.tif", gdal.Open(self.dem))
        del memory
        uri = "type=xyz&url=file:///no/%7Bz%7D/%7Bx%7D/%7By%7D.png&zmax=3&zmin=0"
        layers = [(QgsRasterLayer("/vsimem/dem.tif", "in memory"), "layer in memory: is in the memory of QGIS"),
                  (QgsRasterLayer(uri, "tiles", "wms"), "layer tiles: comes from the provider wms")]  # fmt: skip
        for layer, expected in layers:
            self.assertTrue(layer.isValid())
            with self.assertRaisesRegex(QgsProcessingException, expected):
                self.run_algorithm("skyview", INPUT=layer, OUTPUT=self.path("a.tif"))

    def test_parts_of_files(self):
        with zipfile.ZipFile(self.path("dem.zip"), "w") as archive:
            archive.write(self.dem, "a/dem.tif")
            archive.write(self.dem, "a/other.tif")
        gdal.Translate(self.path("dem.gpkg"), self.dem, format="GPKG", creationOptions=["RASTER_TABLE=heights"])
        for source in (f"/vsizip/{self.path('dem.zip')}/a/dem.tif", f"GPKG:{self.path('dem.gpkg')}:heights"):
            self.assertEqual(dem_of(self.loaded(source)).file, source)
            self.run_algorithm("skyview", INPUT=self.layers[-1], DIRECTIONS=4, OUTPUT=self.path("sky.tif"))

    def test_open_options_are_refused(self):
        with self.assertRaisesRegex(RelevoError, "layer loaded: has open options"):
            dem_of(self.loaded(self.dem + "|option:NUM_THREADS=2"))

    def test_more_options(self):
        parameters = {"TIME": "2026-12-21T09:00:00", "OPTIONS": "--highest 1080 --co 'COMPRESS=LZW'"}
        self.run_algorithm("shadow", OUTPUT=self.path("a.tif"), **parameters)
        self.assertEqual(gdal.Open(self.path("a.tif")).GetMetadata("IMAGE_STRUCTURE")["COMPRESSION"], "LZW")
        with self.assertRaisesRegex(QgsProcessingException, "options: --name 'a: No closing quotation"):
            self.run_algorithm("skyview", OUTPUT=self.path("a.tif"), OPTIONS="--name 'a")
        with self.assertRaisesRegex(QgsProcessingException, "^--nonsense: no such option"):
            self.run_algorithm("skyview", OUTPUT=self.path("a.tif"), OPTIONS="--nonsense")

    def test_the_crs_and_the_band_of_the_layer(self):
        layer = QgsRasterLayer(self.dem, "dem")
        self.assertEqual((dem_of(layer).crs, dem_of(layer).file), (None, self.dem))
        layer.setCrs(QgsCoordinateReferenceSystem("EPSG:4258"))
        self.assertEqual((dem_of(layer, 1, "ft").crs, dem_of(layer, 1, "ft").unit), ("EPSG:4258", "ft"))

    def test_times(self):
        time = QDateTime(QDate(2026, 6, 21), QTime(18, 30))
        self.assertEqual(when_of(time, "", "")["time"], "2026-06-21T18:30:00")
        self.assertEqual(when_of(time, "", "Asia/Tokyo")["zone"], "Asia/Tokyo")
        self.assertEqual(when_of(QDateTime(time.date(), time.time(), Qt.UTC), "", "")["time"], "2026-06-21T18:30:00Z")
        self.assertEqual(when_of(QDateTime(time.date(), time.time(), Qt.OffsetFromUTC, 7200), "", "")["time"],
                         "2026-06-21T16:30:00Z")  # fmt: skip
        self.assertEqual((when_of(time, "noon", "")["time"], when_of(time, "noon", "")["date"]), ("noon", "2026-06-21"))
        self.assertEqual(when_of("2026-03-08 02:30", "", "")["time"], "2026-03-08T02:30")
        self.assertEqual(when_of("2026-06-21T12:00+02:00", "noon", "")["date"], "2026-06-21")
        self.assertIsNone(when_of(None, "", ""))
        with self.assertRaisesRegex(RelevoError, "expected also a time"):
            when_of(None, "noon", "")


class Documentation(Case):
    def test_the_line_of_python(self):
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(self.folder)
        lines = [line.strip() for line in (ROOT / "docs" / "qgis.md").read_text().splitlines()]
        (line,) = [line for line in lines if line.startswith("processing.run(")]
        result = eval(line, {"processing": processing})  # noqa: S307, our own documentation
        self.assertTrue(os.path.exists(result["OUTPUT"]))


class Points(Case):
    """Two points in a projected CRS, the second outside of the DEM."""

    def setUp(self):
        super().setUp()
        self.points = QgsVectorLayer("Point?crs=EPSG:32616&field=id:integer", "points", "memory")
        for number, at in enumerate(("Point(751000 4020000)", "Point(500000 4020000)"), 1):
            feature = QgsFeature(self.points.fields())
            feature.setGeometry(QgsGeometry.fromWkt(at))
            feature.setAttributes([number])
            self.points.dataProvider().addFeature(feature)
        self.points.updateExtents()

    def expected(self):
        """Horizons of the first point in steps of 90 degrees [degrees]."""
        pathlib.Path(self.path("p.csv")).write_text("x,y\n751000,4020000\n")
        text = relevo("sun", "horizon", self.dem, "--points", self.path("p.csv"), "--points-crs", "EPSG:32616", "--step",
                      90, "--eye-height", 2, "--csv").stdout  # fmt: skip
        lines = [line.split(",") for line in text.splitlines() if not line.startswith("#")]
        return [float(row[lines[0].index("horizon_deg")]) for row in lines[1:]]

    def test_a_row_for_each_azimuth(self):
        output = self.run_algorithm("horizon", POINTS=self.points, STEP=90, EYE_HEIGHT=2, OUTPUT="memory:")["OUTPUT"]
        names = [field.name() for field in output.fields()]
        self.assertEqual(names, ["id", "azimuth_deg", "horizon_deg", "distance_m", "error"])
        rows = list(output.getFeatures())
        self.assertEqual([row["azimuth_deg"] for row in rows[:4]], [0, 90, 180, 270])
        for row, expected in zip(rows, self.expected()):
            self.assertAlmostEqual(row["horizon_deg"], expected, delta=1e-4)
        self.assertEqual(len(rows), 5)
        self.assertIn("outside of the DEM", rows[4]["error"])
        self.assertEqual(output.crs().authid(), "EPSG:32616")
        self.assertEqual(rows[0].geometry().asWkt(), "Point (751000 4020000)")

    def test_a_field_for_each_azimuth(self):
        parameters = {"POINTS": self.points, "STEP": 90, "EYE_HEIGHT": 2, "LAYOUT": "fields", "OUTPUT": "memory:"}
        output = self.run_algorithm("horizon", **parameters)["OUTPUT"]
        inside, outside = output.getFeatures()
        for name, expected in zip(("h_0", "h_90", "h_180", "h_270"), self.expected()):
            self.assertAlmostEqual(inside[name], expected, delta=1e-4)
        self.assertIn("outside of the DEM", outside["error"])

    def test_fields_of_the_same_name_and_features_without_a_point(self):
        self.points.dataProvider().addAttributes([QgsField("error", QVariant.String)])
        self.points.updateFields()
        empty = QgsFeature(self.points.fields())
        empty.setAttributes([3, "mine"])
        self.points.dataProvider().addFeature(empty)
        output = self.run_algorithm("horizon", POINTS=self.points, STEP=90, LAYOUT="fields", OUTPUT="memory:")["OUTPUT"]
        self.assertEqual([field.name() for field in output.fields()], ["id", "error", "h_0", "h_90", "h_180", "h_270", "error_2"])
        _, outside = output.getFeatures()
        self.assertIn("outside of the DEM", outside["error_2"])
        self.assertIn("1 features have no point: they are skipped", self.feedback.warnings)

    def test_points_without_a_crs_are_refused(self):
        self.points.setCrs(QgsCoordinateReferenceSystem())
        with self.assertRaisesRegex(QgsProcessingException, "points: have no coordinate system"):
            self.run_algorithm("horizon", POINTS=self.points, OUTPUT="memory:")


class Pictures(Case):
    def test_a_map_has_the_place_of_the_dem(self):
        output = self.run_algorithm("map", WIDTH=300, HEIGHT=300, PRESET="relief", OUTPUT=self.path("map.tif"))["OUTPUT"]
        ours, dem = gdal.Open(output), gdal.Open(self.dem)
        self.assertEqual((ours.GetGeoTransform()[0], ours.GetGeoTransform()[3]),
                         (dem.GetGeoTransform()[0], dem.GetGeoTransform()[3]))  # fmt: skip
        self.assertGreater(ours.ReadAsArray()[:3].std(), 5)

    def test_a_picture_with_an_overlay(self):
        self.run_algorithm("shadow", TIME="2026-12-21T09:00:00", OUTPUT=self.path("shadow.tif"))
        parameters = {"WIDTH": 320, "HEIGHT": 200, "SIDE": "south", "ELEVATION": 40, "STAMPS": ["date"],
                      "VALUES": "haze.density=0.2", "OUTPUT": self.path("a.png")}  # fmt: skip
        self.run_algorithm("capture", TIME="2026-12-21T09:00:00", OVERLAY=self.path("shadow.tif"), **parameters)
        ours = gdal.Open(self.path("a.png"))
        self.assertEqual((ours.RasterXSize, ours.RasterYSize), (320, 200))
        words = next(text for text in self.feedback.infos if " capture " in text)
        for part in ("--view south,el=40", "--stamp date", "--set haze.density=0.2", "--overlay"):
            self.assertIn(part, words)

    def test_the_year_at_a_point(self):
        parameters = {"POINT": "751000,4020000 [EPSG:32616]", "YEAR": 2026, "OUTPUT": self.path("a.png"),
                      "TABLE": self.path("a.csv")}  # fmt: skip
        self.run_algorithm("carpet", **parameters)
        self.assertEqual(gdal.Open(self.path("a.png")).RasterCount > 0, True)
        rows = [line for line in pathlib.Path(self.path("a.csv")).read_text().splitlines() if not line.startswith("#")]
        self.assertEqual(len(rows), 366)


class Library(Case):
    """The Python package gives what the program gives."""

    def setUp(self):
        super().setUp()
        folder = os.environ.get("RELEVO_PYTHON_PACKAGE")
        if folder and folder not in sys.path:
            sys.path.insert(0, folder)
        if library.find() is None:
            self.skipTest("the Python package relevo is not there")
        self.addCleanup(setattr, program, "find", program.find)
        program.find = lambda setting: None
        self.assertIsInstance(find_backend(), library.Library)

    def test_rasters(self):
        cases = (
            ("sunhours", {"FROM": "2026-06-21", "BANDS": ["hours", "global"]},
             ["sun", "hours", self.dem, "--date", "2026-06-21", "--bands", "hours,global"]),
            ("shadow", {"TIME": "2026-12-21T09:00:00"}, ["sun", "shadow", self.dem, "--time", "2026-12-21T09:00:00"]),
            ("shadow", {"TIME": "2026-12-21T09:00:00", "EVENT": "sunset-30min", "SOFT": True},
             ["sun", "shadow", self.dem, "--time", "sunset-30min", "--date", "2026-12-21", "--soft"]),
            ("skyview", {"DIRECTIONS": 8}, ["sun", "sky-view", self.dem, "--directions", 8]),
        )  # fmt: skip
        for word, parameters, words in cases:
            output = self.run_algorithm(word, OUTPUT=self.path("a.tif"), **parameters)["OUTPUT"]
            self.expect_values(output, *words, "--overwrite")
        self.assertIn("time zone America/New_York of the place; tz= sets another", self.feedback.infos)
        self.assertTrue(any(text.startswith("mountains outside this DEM") for text in self.feedback.warnings))
        self.assertTrue(self.feedback.shares)

    def test_maps_and_pictures(self):
        for word, ending, words in (("map", "tif", ["--ortho"]), ("capture", "png", ["--view", "top,zoom=2"])):
            sides = {} if word == "map" else {"SIDE": "top", "ZOOM": 2}
            output = self.path("a." + ending)
            self.run_algorithm(word, TIME="2026-06-21T18:30:00", WIDTH=200, HEIGHT=200, PRESET="relief", OUTPUT=output,
                               **sides)  # fmt: skip
            expected = self.path("b." + ending)
            relevo("capture", self.dem, "--time", "2026-06-21T18:30:00", "--size", "200x200", "--preset", "relief", *words,
                   "-o", expected)  # fmt: skip
            ours, theirs = gdal.Open(output), gdal.Open(expected)
            self.assertEqual(ours.GetGeoTransform(), theirs.GetGeoTransform())
            self.assertTrue(numpy.array_equal(ours.ReadAsArray()[:3], theirs.ReadAsArray()[:3]))

    def test_horizons_and_errors(self):
        backend = find_backend()
        layer = QgsRasterLayer(self.dem, "")
        inside, outside = backend.horizons(dem_of(layer), [(36.3, -84.2), (10, 10)], 2, 90, library.Watch())
        theirs, _ = program.Program(PROGRAM).horizons(
            dem_of(layer), [(36.3, -84.2), (10, 10)], 2, 90, library.Watch()
        )
        for mine, other in zip(inside, theirs):
            self.assertAlmostEqual(mine.horizon_deg, other.horizon_deg, delta=1e-4)
        self.assertTrue(outside.startswith("horizon: 10,10: outside of the DEM"), outside)
        with self.assertRaisesRegex(QgsProcessingException, "^(time zone|tz): Nowhere/X: no such time zone"):
            self.run_algorithm("shadow", TIME="2026-06-21T12:00:00", ZONE="Nowhere/X", OUTPUT=self.path("a.tif"))
        with self.assertRaisesRegex(QgsProcessingException, "needs the program relevo"):
            self.run_algorithm("carpet", POINT="-84.2,36.3", OUTPUT=self.path("a.png"))

    def test_cancelling(self):
        self.feedback = Feedback(cancels=True)
        algorithm = QgsApplication.processingRegistry().algorithmById("relevo:sunhours")
        parameters = {"INPUT": self.dem, "YEAR": 2026, "OUTPUT": self.path("year.tif")}
        results, _ = algorithm.run(parameters, QgsProcessingContext(), self.feedback)
        self.assertEqual(results, {})
        self.assertFalse(os.path.exists(self.path("year.tif")))


if __name__ == "__main__":
    result = unittest.main(exit=False).result
    plugin.unload()
    sys.stdout.flush()
    # Qt's own cleanup at the end of an interpreter is not what is tested.
    os._exit(0 if result.wasSuccessful() else 1)

"""The documentation as a site: tools/site.py puts its sources together."""
project = "Relevo"
author = copyright = "The Relevo authors"
extensions = ["myst_parser"]
myst_enable_extensions = ["deflist", "dollarmath"]
myst_heading_anchors = 4
smartquotes = False  # "--clip" is an option
html_theme = "sphinx_rtd_theme"
html_title = "Relevo"
html_static_path = []
html_copy_source = False
html_show_sphinx = False
html_favicon = "../../packaging/desktop/org.relevo.Relevo.svg"
exclude_patterns = ["examples/*/README.md"]
# Console lines and GLSL that Pygments does not know by name.
suppress_warnings = ["misc.highlighting_failure"]

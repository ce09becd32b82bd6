# The ParaView plugin BSplineReconstruction.so, from Plugin/paraview.plugin and xml/*.xml.
paraview_plugin_scan(
  PLUGIN_FILES "${CMAKE_SOURCE_DIR}/Plugin/paraview.plugin"
  PROVIDES_PLUGINS bsr_plugins
  ENABLE_BY_DEFAULT ON)
paraview_plugin_build(
  PLUGINS ${bsr_plugins}
  PLUGINS_FILE_NAME "bsplinereconstruction.plugins.xml"
  AUTOLOAD ${bsr_plugins})

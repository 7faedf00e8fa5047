// Asks for all modules of a view at once. Without this the browser finds each in the one that imports it, over seven steps. A
// classic script, so that it runs before the modules; tests/web/preload.test.mjs compares the lists with the imports.
(() => {
  const REPORT = [
    "across_devices advice answer_card api baselines_view chart checks_view chosen color_bar columns error_panel exr",
    "format frontier_view image_viewer layer magma menu notes paint patience picture_data picture_pane",
    "pixel_view report_actions report_head report_page report_pictures report_view result_tables scales",
    "spec_model suite_view sweep sweep_grid sweep_view timing_strip value_table view_state viewer_keys",
    "viewer_stage viewer_toolbar viewer_tools viewport worst_walk",
  ].join(" ");
  const DIFF = [
    "api chosen color_bar columns diff_table diff_view error_panel exr format image_viewer layer magma",
    "menu paint picture_data picture_pane sweep value_table view_state viewer_keys viewer_stage",
    "viewer_toolbar viewer_tools viewport worst_walk",
  ].join(" ");
  const FORM = [
    "api asset_field checks_form columns compare_view field_errors field_frame form_section format",
    "json_position methods_form notes number_input param_form presets source_field spec_form spec_methods",
    "spec_model suite_chooser sweep sweep_form title_form",
  ].join(" ");
  const VIEWS = [
    [/^#\/reports\/./, REPORT],
    [/^#\/diff\//, DIFF],
    [/^#\/new/, FORM],
  ];
  const [, names] = VIEWS.find(([pattern]) => pattern.test(location.hash)) ?? [];
  for (const name of ["app", "address", "dom", "drop", ...(names?.split(" ") ?? [])]) {
    const link = document.createElement("link");
    link.rel = "modulepreload";
    link.href = `${name}.js`;
    document.head.append(link);
  }
})();

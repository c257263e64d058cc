//! The template's plugins as a library that is loaded at run time.

regrasp_abi::export_plugins!(
    regrasp_template::contact_model::ENTRY,
    regrasp_template::stability_test::ENTRY,
    regrasp_template::surface::ENTRY,
    regrasp_template::sampler::ENTRY,
    regrasp_template::local_planner::ENTRY,
    regrasp_template::graph_strategy::ENTRY,
);

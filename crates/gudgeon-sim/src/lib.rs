//! Case files, scenes, planner, runner and studies.

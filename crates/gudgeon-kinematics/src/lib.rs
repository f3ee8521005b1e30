//! Slider-crank and cylinder-pressure models.

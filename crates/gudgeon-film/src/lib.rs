//! Oil, film temperature and the film under a ring face.

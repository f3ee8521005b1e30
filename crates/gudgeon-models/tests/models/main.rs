//! All built-in models.

use gudgeon_models as _;

mod contract;
mod running;

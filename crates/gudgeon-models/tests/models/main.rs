//! All built-in models.

#![allow(clippy::disallowed_methods, reason = "what is expected need not be the same bits on every platform")]

use gudgeon_models as _;

mod contract;
mod running;

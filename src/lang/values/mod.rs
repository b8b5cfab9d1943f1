//! What scripts work with: values, their types and units, origins, and what declarations ask for as plain data.

pub mod conversions;
pub mod origins;
pub mod part;
pub mod places;
pub mod plans;
pub mod settings;
pub mod table;
pub mod types;
pub mod units;
pub mod value;

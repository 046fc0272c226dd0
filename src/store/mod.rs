//! Files: surfaces in HDF5, tables in Parquet, every one of them committed whole or not at all.
//!
//! This room computes nothing. What it writes depends on nothing but its arguments: no clock, host or path is
//! stored, and equal arguments give equal bytes. What it reads it does not trust: whatever the bytes of a
//! file are, the answer is its content or a sentence.

mod attributes;
mod axes;
mod builder;
pub mod commit;
pub mod container;
mod dataset;
mod error;
pub mod force_curve;
mod frame;
mod halfway;
pub mod hdf5;
pub mod hdf5_scan;
mod heaps;
pub mod heartbeat;
mod maps;
pub mod parquet;
mod quality;
mod receipt;
pub mod scan;
mod surface_header;

pub use builder::FrameBuilder;
pub(crate) use error::caught;
pub use error::{FrameError, StoreError};
pub use frame::{ColumnData, Frame};
pub use halfway::{CHECKPOINT_VERSION, is_halfway, read_halfway, write_halfway, write_state};
pub use maps::{
    ContactMap, FIELDS as MAP_FIELDS, LoopMaps, MapsHeader, StoredMap, read_loop_maps, read_maps, write_maps,
};
pub use receipt::{Check, Fault, Found, Kept, Made, RECEIPT_VERSION, Receipt, read_receipt, write_receipt};

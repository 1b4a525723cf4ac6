//! Many devices on an engine for tables: the same states and coefficients, whatever the partitions and the machines.

mod cluster;
mod logs;
mod order;
mod queries;

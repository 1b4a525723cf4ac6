//! Clusters of [Ballista](ballista): a scheduler and executors that know the functions, and sessions that ask them.

use crate::functions::register;
use ballista::prelude::SessionContextExt;
use ballista_core::{
    ConfigProducer,
    error::BallistaError,
    registry::BallistaFunctionRegistry,
    utils::{default_config_producer, default_session_builder},
};
use ballista_executor::executor_process::{ExecutorProcessConfig, start_executor_process};
use ballista_scheduler::{
    cluster::BallistaCluster, config::SchedulerConfig, scheduler_process::start_server,
};
use datafusion::{
    error::Result,
    execution::{SessionState, SessionStateBuilder},
    prelude::{SessionConfig, SessionContext},
};
use std::{net::SocketAddr, path::Path, sync::Arc, time::Duration};

/// A session in this process, with the functions.
///
/// # Errors
/// None occurs, because a session takes functions.
pub fn local(settings: SessionConfig) -> Result<SessionContext> {
    let mut state = SessionStateBuilder::new()
        .with_config(settings)
        .with_default_features()
        .build();
    register(&mut state)?;
    Ok(SessionContext::new_with_state(state))
}

/// A session whose queries the scheduler at `df://HOST:PORT` gives to its executors.
///
/// # Errors
/// When the address is not valid.
pub async fn remote(scheduler: &str, settings: SessionConfig) -> Result<SessionContext> {
    let state = default_session_builder(settings)?;
    let mut session = SessionContext::remote_with_state(scheduler, state).await?;
    // A state loses its functions on the way.
    register(&mut session)?;
    Ok(session)
}

/// The state of a session of a scheduler.
fn state(settings: SessionConfig) -> Result<SessionState> {
    let mut state = default_session_builder(settings)?;
    register(&mut state)?;
    Ok(state)
}

/// The settings of sessions that know the functions.
fn settings() -> ConfigProducer {
    Arc::new(default_config_producer)
}

/// Serves as a scheduler until the process ends. An executor that is silent for `patience` is given up, and its work is done by
/// others.
///
/// # Errors
/// When the address cannot be served.
pub async fn scheduler(address: SocketAddr, patience: Duration) -> Result<(), BallistaError> {
    let config = SchedulerConfig {
        bind_host: address.ip().to_string(),
        external_host: address.ip().to_string(),
        bind_port: address.port(),
        executor_timeout_seconds: patience.as_secs().max(1),
        expire_dead_executor_interval_seconds: (patience.as_secs() / 4).max(1),
        override_config_producer: Some(settings()),
        override_session_builder: Some(Arc::new(state)),
        ..SchedulerConfig::default()
    };
    let cluster = BallistaCluster::new_from_config(&config).await?;
    start_server(cluster, address, Arc::new(config)).await
}

/// Works for the scheduler at `HOST` and `PORT` until the process ends, with so many threads and with results between stages in a
/// folder. Others reach it at `address` and at the port above that.
///
/// # Errors
/// When the address cannot be served, or the scheduler does not answer within a minute.
pub async fn executor(
    scheduler: (&str, u16),
    address: SocketAddr,
    threads: usize,
    folder: &Path,
    patience: Duration,
) -> Result<(), BallistaError> {
    let registry = BallistaFunctionRegistry::from(&state(SessionConfig::new())?);
    let (host, port) = scheduler;
    let config = ExecutorProcessConfig {
        bind_host: address.ip().to_string(),
        external_host: Some(address.ip().to_string()),
        port: address.port(),
        grpc_port: address.port() + 1,
        scheduler_host: host.to_owned(),
        scheduler_port: port,
        scheduler_connect_timeout_seconds: 60,
        vcores: threads,
        work_dir: Some(folder.display().to_string()),
        executor_heartbeat_interval_seconds: (patience.as_secs() / 4).max(1),
        override_function_registry: Some(Arc::new(registry)),
        override_config_producer: Some(settings()),
        ..ExecutorProcessConfig::default()
    };
    start_executor_process(Arc::new(config)).await
}

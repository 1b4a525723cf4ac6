//! `allanite-fleet`: a query over Parquet in this process or on a cluster, and the parts of a cluster.

use allanite_fleet::cluster::{executor, local, remote, scheduler};
use anyhow::{Context as _, Result, bail};
use clap::{Args, Parser, Subcommand};
use datafusion::{
    arrow::util::pretty::pretty_format_batches,
    error::DataFusionError,
    execution::SendableRecordBatchStream,
    parquet::arrow::ArrowWriter,
    prelude::{ParquetReadOptions, SessionConfig},
};
use futures::TryStreamExt;
use std::{
    fs,
    io::Write,
    net::{SocketAddr, TcpStream},
    path::{Path, PathBuf},
    process::ExitCode,
    time::Duration,
};

/// Batches of samples are large, and the usual allocator returns such memory to the system after each of them.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

/// Coefficients of many gyros from their logs in Parquet, by SQL.
#[derive(Debug, Parser)]
#[command(name = "allanite-fleet", version)]
struct CommandLine {
    #[command(subcommand)]
    work: Work,
}

#[derive(Debug, Subcommand)]
enum Work {
    /// Answer a query, in this process or on a cluster.
    Query(Query),
    /// Serve as the scheduler of a cluster. Whoever reaches the address can give it work: it belongs into a network of one's own.
    Scheduler {
        /// The address to serve.
        #[arg(long, value_name = "ADDRESS:PORT", default_value = "127.0.0.1:50050")]
        bind: SocketAddr,
        /// The time in s after which a silent executor is given up and its work is done by others.
        #[arg(long, value_name = "SECONDS", default_value_t = 60)]
        patience: u64,
    },
    /// Work for a scheduler.
    Executor {
        /// The scheduler.
        #[arg(long, value_name = "HOST:PORT", default_value = "127.0.0.1:50050")]
        scheduler: String,
        /// The address to serve to other executors; the port above it is served too.
        #[arg(long, value_name = "ADDRESS:PORT", default_value = "127.0.0.1:50051")]
        bind: SocketAddr,
        /// The number of threads; without it, one for each core.
        #[arg(long, value_name = "NUMBER")]
        threads: Option<usize>,
        /// The folder for results between stages; without it, one that is made for this run.
        #[arg(long, value_name = "FOLDER")]
        folder: Option<PathBuf>,
        /// The `--patience` of the scheduler.
        #[arg(long, value_name = "SECONDS", default_value_t = 60)]
        patience: u64,
    },
}

#[derive(Debug, Args)]
struct Query {
    /// The query, such as "SELECT device, axis, allan_fit(allan_state(start, counts, rate, scale), 'deg/s') AS fit FROM logs GROUP BY
    /// device, axis".
    sql: String,
    /// A table of the query, and its file or folder of Parquet; may be given several times.
    #[arg(long = "table", value_name = "NAME=PATH", required = true, value_parser = table)]
    tables: Vec<(String, String)>,
    /// The scheduler of a cluster; without it, this process does the work. Its executors read the tables under the same paths.
    #[arg(long, value_name = "df://HOST:PORT")]
    scheduler: Option<String>,
    /// The number of partitions that are worked on at once; without it, one for each core.
    #[arg(long, value_name = "NUMBER")]
    partitions: Option<usize>,
    /// The number of rows that are in memory at once. A row of a batch is thousands of samples; with one sample a row, 8192 is faster.
    #[arg(long, value_name = "NUMBER", default_value_t = 16)]
    rows: usize,
    /// The Parquet file to write; without it, a table is printed.
    #[arg(long, value_name = "FILE")]
    output: Option<PathBuf>,
}

/// A table and its path.
fn table(text: &str) -> Result<(String, String), String> {
    let parts = text
        .split_once('=')
        .filter(|(name, path)| !name.is_empty() && !path.is_empty());
    let (name, path) = parts.ok_or("write NAME=PATH, such as logs=folder")?;
    Ok((name.to_owned(), path.to_owned()))
}

/// Queries are planned by recursion, which needs more than the usual stack.
const STACK: usize = 32 << 20;

fn main() -> ExitCode {
    let command = CommandLine::parse();
    let runtime = tokio::runtime::Builder::new_multi_thread()
        .enable_all()
        .thread_stack_size(STACK)
        .build();
    let done = runtime
        .context("no threads")
        .and_then(|runtime| runtime.block_on(run(command.work)));
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            // Nobody is left to tell when standard error is closed.
            let _ = writeln!(std::io::stderr(), "allanite-fleet: {}", one_line(&error));
            ExitCode::from(2)
        }
    }
}

/// The root of an error, in one line.
fn one_line(error: &anyhow::Error) -> String {
    let text = match error
        .downcast_ref::<DataFusionError>()
        .map(DataFusionError::find_root)
    {
        Some(DataFusionError::External(root)) => root.to_string(),
        Some(root) => root.strip_backtrace(),
        None => format!("{error:#}"),
    };
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

async fn run(work: Work) -> Result<()> {
    match work {
        Work::Query(query) => query.run().await,
        Work::Scheduler { bind, patience } => {
            Ok(scheduler(bind, Duration::from_secs(patience)).await?)
        }
        Work::Executor {
            scheduler,
            bind,
            threads,
            folder,
            patience,
        } => {
            let address = scheduler
                .rsplit_once(':')
                .and_then(|(host, port)| Some((host, port.parse().ok()?)));
            let Some((host, port)) = address else {
                bail!("--scheduler {scheduler}: no port; write HOST:PORT");
            };
            let cores = std::thread::available_parallelism().map_or(1, usize::from);
            let own = match &folder {
                Some(_) => None,
                None => Some(tempfile::tempdir()?),
            };
            let folder = folder
                .as_deref()
                .or(own.as_ref().map(tempfile::TempDir::path));
            let folder = folder.context("no folder for results")?;
            fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
            let patience = Duration::from_secs(patience);
            executor(
                (host, port),
                bind,
                threads.unwrap_or(cores),
                folder,
                patience,
            )
            .await?;
            Ok(())
        }
    }
}

impl Query {
    async fn run(&self) -> Result<()> {
        let mut settings = SessionConfig::new().with_batch_size(self.rows.max(1));
        if let Some(partitions) = self.partitions {
            settings = settings.with_target_partitions(partitions.max(1));
        }
        let session = match &self.scheduler {
            Some(scheduler) => {
                answers(scheduler)?;
                remote(scheduler, settings).await?
            }
            None => local(settings)?,
        };
        for (name, path) in &self.tables {
            if !Path::new(path).exists() {
                bail!("{path}: no such file or folder; check the path");
            }
            session
                .register_parquet(name.as_str(), path.as_str(), ParquetReadOptions::default())
                .await?;
        }
        let found = session.sql(&self.sql).await?.execute_stream().await?;
        match &self.output {
            Some(output) => written(found, output).await,
            None => {
                let rows: Vec<_> = found.try_collect().await?;
                writeln!(std::io::stdout(), "{}", pretty_format_batches(&rows)?)?;
                Ok(())
            }
        }
    }
}

/// Whether somebody answers at `df://HOST:PORT`, which the engine would tell in other words.
fn answers(scheduler: &str) -> Result<()> {
    let Some(address) = scheduler
        .strip_prefix("df://")
        .filter(|address| address.contains(':'))
    else {
        bail!("--scheduler {scheduler}: no address; write df://HOST:PORT");
    };
    match TcpStream::connect(address) {
        Ok(_) => Ok(()),
        Err(error) => bail!(
            "--scheduler {scheduler}: nobody answers ({error}); start `allanite-fleet scheduler` there"
        ),
    }
}

/// Writes rows to a file, which is there when it is whole.
async fn written(mut rows: SendableRecordBatchStream, output: &Path) -> Result<()> {
    let folder = output
        .parent()
        .filter(|folder| !folder.as_os_str().is_empty())
        .unwrap_or(Path::new("."));
    let file = tempfile::Builder::new()
        .permissions(std::os::unix::fs::PermissionsExt::from_mode(0o644))
        .tempfile_in(folder)
        .with_context(|| output.display().to_string())?;
    let mut writer = ArrowWriter::try_new(file, rows.schema(), None)?;
    let mut number = 0;
    while let Some(batch) = rows.try_next().await? {
        number += batch.num_rows();
        writer.write(&batch)?;
    }
    let file = writer.into_inner()?;
    file.as_file().sync_all()?;
    file.persist(output)
        .with_context(|| output.display().to_string())?;
    writeln!(std::io::stderr(), "{number} rows in {}", output.display())?;
    Ok(())
}

//! Tables as Parquet files. The same table gives the same bytes.

use std::path::Path;
use std::sync::Arc;

use bytes::Bytes;
use indexmap::IndexMap;
use parquet::basic::{LogicalType, Repetition, Type as Physical};
use parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use parquet::data_type::{ByteArray, ByteArrayType, DataType, DoubleType, Int64Type};
use parquet::errors::Result;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::reader::{ChunkReader, FileReader, SerializedFileReader};
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::Type;

use super::table::{Column, Table, Values};

/// Who wrote a file, beside its version in the table's own words: files of two versions with equal rows are equal.
const WRITTEN_BY: &str = "gudgeon";
/// Key of the units of the columns, a JSON object.
const UNITS: &str = "units";
/// Key of what the columns are, a JSON object.
const DESCRIPTIONS: &str = "descriptions";

/// A table as the bytes of a Parquet file, uncompressed. Units stand under the key `units` of its metadata and what a column is under `descriptions`,
/// beside what is known of the table.
///
/// # Errors
/// None that memory does not raise.
pub fn to_parquet(table: &Table) -> Result<Vec<u8>> {
    let fields = table.columns.iter().map(|(name, c)| field(name, &c.values)).collect::<Result<_>>()?;
    let schema = Type::group_type_builder("table").with_fields(fields).build()?;
    let mut about = vec![
        KeyValue::new(UNITS.to_owned(), of_columns(table, |c| &c.unit)),
        KeyValue::new(DESCRIPTIONS.to_owned(), of_columns(table, |c| &c.what)),
    ];
    about.extend(table.about.iter().map(|(k, v)| KeyValue::new(k.clone(), v.clone())));
    let properties = WriterProperties::builder()
        .set_created_by(WRITTEN_BY.to_owned())
        .set_key_value_metadata(Some(about))
        .build();
    let mut writer = SerializedFileWriter::new(Vec::new(), Arc::new(schema), Arc::new(properties))?;
    let mut group = writer.next_row_group()?;
    for column in table.columns.values() {
        match &column.values {
            Values::Numbers(v) => write::<DoubleType>(&mut group, v)?,
            Values::Integers(v) => write::<Int64Type>(&mut group, v)?,
            Values::Texts(v) => {
                let bytes: Vec<Option<ByteArray>> =
                    v.iter().map(|t| t.as_deref().map(ByteArray::from)).collect();
                write::<ByteArrayType>(&mut group, &bytes)?;
            }
        }
    }
    group.close()?;
    writer.into_inner()
}

/// What the columns say of themselves, as a JSON object without those that say nothing.
fn of_columns(table: &Table, text: impl Fn(&Column) -> &String) -> String {
    let said = table.columns.iter().filter(|(_, c)| !text(c).is_empty());
    let all: serde_json::Map<String, serde_json::Value> =
        said.map(|(name, c)| (name.clone(), text(c).clone().into())).collect();
    serde_json::Value::from(all).to_string()
}

/// A column that may have holes.
fn field(name: &str, values: &Values) -> Result<Arc<Type>> {
    let (physical, logical) = match values {
        Values::Numbers(_) => (Physical::DOUBLE, None),
        Values::Integers(_) => (Physical::INT64, None),
        Values::Texts(_) => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
    };
    let builder = Type::primitive_type_builder(name, physical);
    Ok(Arc::new(builder.with_logical_type(logical).with_repetition(Repetition::OPTIONAL).build()?))
}

fn write<T: DataType>(
    group: &mut SerializedRowGroupWriter<'_, Vec<u8>>,
    values: &[Option<T::T>],
) -> Result<()> {
    let Some(mut column) = group.next_column()? else { return Ok(()) };
    let there: Vec<T::T> = values.iter().flatten().cloned().collect();
    let levels: Vec<i16> = values.iter().map(|v| i16::from(v.is_some())).collect();
    column.typed::<T>().write_batch(&there, Some(&levels), None)?;
    column.close()
}

/// The table of a Parquet file that [`to_parquet`] wrote.
///
/// # Errors
/// Bytes that are no such file.
pub fn from_parquet(bytes: Vec<u8>) -> Result<Table> {
    let file = SerializedFileReader::new(Bytes::from(bytes))?;
    let mut table = Table { about: about(&file), ..Table::default() };
    let mut said = |key| -> IndexMap<String, String> {
        table.about.shift_remove(key).and_then(|u| serde_json::from_str(&u).ok()).unwrap_or_default()
    };
    let (units, whats) = (said(UNITS), said(DESCRIPTIONS));
    let columns = file.metadata().file_metadata().schema_descr().columns().to_vec();
    for g in 0..file.num_row_groups() {
        let group = file.get_row_group(g)?;
        let rows = usize::try_from(group.metadata().num_rows()).unwrap_or(0);
        let mut part = Table::default();
        for (k, column) in columns.iter().enumerate() {
            let values = match group.get_column_reader(k)? {
                ColumnReader::DoubleColumnReader(r) => Values::Numbers(read(r, rows)?),
                ColumnReader::Int64ColumnReader(r) => Values::Integers(read(r, rows)?),
                ColumnReader::ByteArrayColumnReader(r) => {
                    let text = |b: ByteArray| String::from_utf8_lossy(b.data()).into_owned();
                    Values::Texts(read(r, rows)?.into_iter().map(|v| v.map(text)).collect())
                }
                _ => {
                    return Err(parquet::errors::ParquetError::General(format!(
                        "a column of another type: {}",
                        column.name()
                    )));
                }
            };
            let of = |all: &IndexMap<String, String>| all.get(column.name()).cloned().unwrap_or_default();
            let own = Column { unit: of(&units), what: of(&whats), values };
            part.columns.insert(column.name().to_owned(), own);
        }
        table.append(part).map_err(parquet::errors::ParquetError::General)?;
    }
    Ok(table)
}

/// What is known of the table of a file.
fn about<R: ChunkReader + 'static>(file: &SerializedFileReader<R>) -> IndexMap<String, String> {
    let all = file.metadata().file_metadata().key_value_metadata();
    all.into_iter().flatten().filter_map(|kv| Some((kv.key.clone(), kv.value.clone()?))).collect()
}

fn read<T: DataType>(mut reader: ColumnReaderImpl<T>, rows: usize) -> Result<Vec<Option<T::T>>> {
    let (mut levels, mut values) = (Vec::with_capacity(rows), Vec::with_capacity(rows));
    while levels.len() < rows {
        let (read, _, _) = reader.read_records(rows - levels.len(), Some(&mut levels), None, &mut values)?;
        if read == 0 {
            break;
        }
    }
    let mut there = values.into_iter();
    Ok(levels.into_iter().map(|l| (l > 0).then(|| there.next()).flatten()).collect())
}

/// What is known of the table of a file, without its rows.
///
/// # Errors
/// A file that cannot be read or is no Parquet file.
pub fn about_parquet(path: &Path) -> Result<IndexMap<String, String>> {
    let file = SerializedFileReader::new(std::fs::File::open(path)?)?;
    Ok(about(&file))
}

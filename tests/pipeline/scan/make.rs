//! Files byte by byte, so that every one of them can be wrong.

use std::io::{Cursor, Write};

use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

/// A file of NumPy.
pub fn npy(version: u8, line: &str, data: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::from(*b"\x93NUMPY");
    bytes.extend([version, 0]);
    if version == 1 {
        bytes.extend((line.len() as u16).to_le_bytes());
    } else {
        bytes.extend((line.len() as u32).to_le_bytes());
    }
    bytes.extend(line.bytes());
    bytes.extend(data);
    bytes
}

/// The line of such a file.
pub fn npy_line(descr: &str, fortran: &str, shape: &str) -> String {
    format!("{{'descr': '{descr}', 'fortran_order': {fortran}, 'shape': {shape}, }}          \n")
}

/// What an attribute says.
#[derive(Clone)]
pub enum Said {
    Text(&'static str),
    Int(i32),
    Double(f64),
}

/// A variable of NetCDF: its dimensions, attributes, kind and bytes (those of one record after the other, if it grows).
#[derive(Clone)]
pub struct Variable {
    pub name: &'static str,
    pub dimensions: Vec<u32>,
    pub attributes: Vec<(&'static str, Said)>,
    pub kind: u32,
    pub data: Vec<u8>,
}

/// A classic NetCDF file of any version.
#[derive(Clone)]
pub struct Cdf {
    pub version: u8,
    pub records: u32,
    pub dimensions: Vec<(&'static str, u32)>,
    pub variables: Vec<Variable>,
}

impl Cdf {
    fn count(&self, bytes: &mut Vec<u8>, value: u32) {
        if self.version == 5 {
            bytes.extend([0; 4]);
        }
        bytes.extend(value.to_be_bytes());
    }

    fn text(&self, bytes: &mut Vec<u8>, text: &str) {
        self.count(bytes, text.len() as u32);
        bytes.extend(text.bytes());
        bytes.resize(bytes.len().next_multiple_of(4), 0);
    }

    fn grows(&self, variable: &Variable) -> bool {
        variable.dimensions.first().is_some_and(|place| self.dimensions[*place as usize].1 == 0)
    }

    /// The file, header and numbers.
    pub fn bytes(&self) -> Vec<u8> {
        let start = self.header(&vec![0; self.variables.len()]).len();
        let (mut data, mut begins) = (Vec::new(), vec![0; self.variables.len()]);
        for (at, variable) in self.variables.iter().enumerate().filter(|(_, variable)| !self.grows(variable)) {
            begins[at] = start + data.len();
            data.extend(&variable.data);
            data.resize(data.len().next_multiple_of(4), 0);
        }
        let growing: Vec<_> = self.variables.iter().enumerate().filter(|(_, variable)| self.grows(variable)).collect();
        for record in 0..self.records as usize {
            for (at, variable) in &growing {
                if record == 0 {
                    begins[*at] = start + data.len();
                }
                let part = variable.data.len() / self.records as usize;
                data.extend(&variable.data[record * part..(record + 1) * part]);
                if growing.len() > 1 {
                    data.resize(data.len().next_multiple_of(4), 0);
                }
            }
        }
        let mut bytes = self.header(&begins);
        bytes.extend(data);
        bytes
    }

    fn header(&self, begins: &[usize]) -> Vec<u8> {
        let mut bytes = Vec::from(*b"CDF");
        bytes.push(self.version);
        self.count(&mut bytes, self.records);
        bytes.extend(10_u32.to_be_bytes());
        self.count(&mut bytes, self.dimensions.len() as u32);
        for (name, length) in &self.dimensions {
            self.text(&mut bytes, name);
            self.count(&mut bytes, *length);
        }
        self.attributes(&mut bytes, &[("title", Said::Text("a test"))]);
        bytes.extend(11_u32.to_be_bytes());
        self.count(&mut bytes, self.variables.len() as u32);
        for (variable, begin) in self.variables.iter().zip(begins) {
            self.text(&mut bytes, variable.name);
            self.count(&mut bytes, variable.dimensions.len() as u32);
            variable.dimensions.iter().for_each(|place| self.count(&mut bytes, *place));
            self.attributes(&mut bytes, &variable.attributes);
            bytes.extend(variable.kind.to_be_bytes());
            self.count(&mut bytes, variable.data.len() as u32);
            if self.version == 1 {
                bytes.extend((*begin as u32).to_be_bytes());
            } else {
                bytes.extend((*begin as u64).to_be_bytes());
            }
        }
        bytes
    }

    fn attributes(&self, bytes: &mut Vec<u8>, attributes: &[(&str, Said)]) {
        bytes.extend(if attributes.is_empty() { 0_u32 } else { 12 }.to_be_bytes());
        self.count(bytes, attributes.len() as u32);
        for (name, said) in attributes {
            self.text(bytes, name);
            match said {
                Said::Text(text) => {
                    bytes.extend(2_u32.to_be_bytes());
                    self.text(bytes, text);
                }
                Said::Int(value) => {
                    bytes.extend(4_u32.to_be_bytes());
                    self.count(bytes, 1);
                    bytes.extend(value.to_be_bytes());
                }
                Said::Double(value) => {
                    bytes.extend(6_u32.to_be_bytes());
                    self.count(bytes, 1);
                    bytes.extend(value.to_be_bytes());
                }
            }
        }
    }
}

/// Doubles as NetCDF has them.
pub fn big<'a>(values: impl IntoIterator<Item = &'a f64>) -> Vec<u8> {
    values.into_iter().flat_map(|value| value.to_be_bytes()).collect()
}

/// Doubles as the other formats have them.
pub fn little<'a>(values: impl IntoIterator<Item = &'a f64>) -> Vec<u8> {
    values.into_iter().flat_map(|value| value.to_le_bytes()).collect()
}

/// A zip archive of these parts.
pub fn archive(parts: &[(&str, &[u8])], method: CompressionMethod) -> Vec<u8> {
    let mut writer = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, bytes) in parts {
        writer.start_file(*name, SimpleFileOptions::default().compression_method(method)).unwrap();
        writer.write_all(bytes).unwrap();
    }
    writer.finish().unwrap().into_inner()
}

/// The description of an X3P file; `height` is what stands in the axis CZ, `link` what stands behind the link.
pub fn main_xml(size: [&str; 3], height: &str, link: &str) -> String {
    let [x, y, z] = size;
    format!(
        r#"<?xml version="1.0" encoding="UTF-8" standalone="no" ?>
<p:ISO5436_2 xmlns:p="http://www.opengps.eu/2008/ISO5436_2">
  <Record1>
    <Revision>ISO5436 - 2000</Revision>
    <FeatureType>SUR</FeatureType>
    <Axes>
      <CX><AxisType>I</AxisType><DataType>L</DataType><Increment>1.25e-007</Increment><Offset>0</Offset></CX>
      <CY><AxisType>I</AxisType><DataType>L</DataType><Increment>2.5E-7</Increment></CY>
      <CZ><AxisType>A</AxisType>{height}</CZ>
    </Axes>
  </Record1>
  <Record3>
    <MatrixDimension><SizeX>{x}</SizeX><SizeY>{y}</SizeY><SizeZ>{z}</SizeZ></MatrixDimension>
    <DataLink><PointDataLink>bindata/data.bin</PointDataLink>{link}</DataLink>
  </Record3>
</p:ISO5436_2>
"#
    )
}

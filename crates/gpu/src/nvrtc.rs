//! CUDA C to machine code by NVRTC, the compiler of NVIDIA, which needs no device.
//! The library is looked for where the loader of the system looks, as in `LD_LIBRARY_PATH`.

use cudarc::nvrtc::{result, sys};
use std::ffi::CString;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::PathBuf;

/// The variable of the environment that names a folder in which code is kept, so that it can be compiled on another machine.
pub const FOLDER: &str = "MESHFREE_CUBINS";

/// A kernel in machine code.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Cubin {
    /// The code.
    pub code: Vec<u8>,
    /// What the compiler says: with the option `--ptxas-options=-v` also registers and what is spilled.
    pub log: String,
}

/// Whether the library can be loaded.
#[must_use]
pub fn is_there() -> bool {
    // SAFETY: loading the library runs its initialisers and nothing else.
    unsafe { sys::is_culib_present() }
}

/// A program that is given back in the end.
struct Program(sys::nvrtcProgram);

impl Drop for Program {
    fn drop(&mut self) {
        // SAFETY: it was created, and is not used after.
        let _ = unsafe { result::destroy_program(self.0) };
    }
}

/// Compiles a text for an architecture such as `sm_90`, with more options as NVRTC takes them.
///
/// # Errors
///
/// What the compiler says, or that it is not there, with what to do about it.
pub fn compile(source: &str, architecture: &str, options: &[&str]) -> Result<Cubin, String> {
    if !is_there() {
        return Err("NVRTC cannot be loaded; install it (`pip install nvidia-cuda-nvrtc-cu12`) and name its folder in LD_LIBRARY_PATH".into());
    }
    let said = |error: result::NvrtcError| format!("{error:?}");
    let text = CString::new(source).map_err(|error| error.to_string())?;
    let program = Program(result::create_program(&text, None).map_err(said)?);
    let mut all = vec![format!("--gpu-architecture={architecture}")];
    all.extend(options.iter().map(|own| (*own).to_owned()));
    // SAFETY: the program was created, and lives as long as its text.
    let compiled = unsafe { result::compile_program(program.0, &all) };
    // SAFETY: the program was compiled.
    let log = unsafe { result::get_program_log(program.0) }.map_err(said)?;
    let log: Vec<u8> = log.iter().map(|own| own.to_ne_bytes()[0]).collect();
    let log = String::from_utf8_lossy(&log)
        .trim_end_matches('\0')
        .to_owned();
    compiled.map_err(|error| format!("{error:?}: {log}"))?;
    let mut size = 0;
    // SAFETY: the program was compiled for an architecture, so it has code, for which there is room.
    let code = unsafe {
        sys::nvrtcGetCUBINSize(program.0, &raw mut size)
            .result()
            .map_err(said)?;
        let mut code = vec![0_u8; size];
        sys::nvrtcGetCUBIN(program.0, code.as_mut_ptr().cast())
            .result()
            .map_err(said)?;
        code
    };
    Ok(Cubin { code, log })
}

/// Whether code is to be had: there is a folder of it, or the library.
pub(crate) fn has_code() -> bool {
    std::env::var_os(FOLDER).is_some() || is_there()
}

/// The code of a text, with products that may be fused into sums: from the [`FOLDER`], or compiled, and then kept there.
///
/// # Errors
///
/// As [`compile`], or that it cannot be kept.
pub fn code(source: &str, architecture: &str) -> Result<Vec<u8>, String> {
    let mut hasher = DefaultHasher::new();
    (source, architecture).hash(&mut hasher);
    let name = format!("{:016x}.cubin", hasher.finish());
    let file = std::env::var_os(FOLDER).map(|own| PathBuf::from(own).join(name));
    if let Some(Ok(code)) = file.as_ref().map(std::fs::read) {
        return Ok(code);
    }
    let made = compile(source, architecture, &[])?.code;
    if let Some(file) = file {
        let kept = std::fs::write(&file, &made);
        kept.map_err(|error| format!("{}: {error}", file.display()))?;
    }
    Ok(made)
}

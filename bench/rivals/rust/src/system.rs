//! What Rust's own library lacks: a shared number, processor time, and a note before memory ends.

use std::alloc::{GlobalAlloc, Layout, System};
use std::fs::OpenOptions;
use std::os::fd::{AsRawFd, FromRawFd};
use std::sync::atomic::{AtomicI32, AtomicU64, Ordering};

/// How many queries of a request have begun: the first eight bytes of a file that the other side reads.
pub struct Progress(*mut libc::c_void);

impl Progress {
    pub fn open(path: &str) -> std::io::Result<Self> {
        let file = OpenOptions::new().read(true).write(true).open(path)?;
        let protection = libc::PROT_READ | libc::PROT_WRITE;
        // SAFETY: the mapping is of a new place in memory.
        let memory =
            unsafe { libc::mmap(std::ptr::null_mut(), 8, protection, libc::MAP_SHARED, file.as_raw_fd(), 0) };
        if memory == libc::MAP_FAILED {
            return Err(std::io::Error::last_os_error());
        }
        Ok(Progress(memory))
    }

    pub fn set(&self, value: u64) {
        // SAFETY: the mapping has eight bytes, begins at a page, and lives as long as `self`.
        unsafe { (*self.0.cast::<AtomicU64>()).store(value, Ordering::Relaxed) }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        // SAFETY: mapped by open(), and not used any more.
        unsafe { libc::munmap(self.0, 8) };
    }
}

/// Of all threads, in ns.
pub fn processor_ns() -> f64 {
    let mut time = libc::timespec { tv_sec: 0, tv_nsec: 0 };
    // SAFETY: `time` is there to be written.
    unsafe { libc::clock_gettime(libc::CLOCK_PROCESS_CPUTIME_ID, &mut time) };
    1e9 * time.tv_sec as f64 + time.tv_nsec as f64
}

static REPLIES: AtomicI32 = AtomicI32::new(-1);

/// Standard output for replies alone: what a library prints from here on goes to standard error.
pub fn take_standard_output() -> std::fs::File {
    // SAFETY: descriptors 1 and 2 are open; the copy is owned by the file.
    unsafe {
        let copy = libc::dup(1);
        libc::dup2(2, 1);
        REPLIES.store(copy, Ordering::Relaxed);
        std::fs::File::from_raw_fd(copy)
    }
}

/// The system's memory, with a line of the protocol before an allocation that fails ends the program.
struct Noting;

// SAFETY: all calls go to System.
unsafe impl GlobalAlloc for Noting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        noted(System.alloc(layout))
    }
    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        System.dealloc(pointer, layout)
    }
    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        noted(System.alloc_zeroed(layout))
    }
    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        noted(System.realloc(pointer, layout, size))
    }
}

fn noted(memory: *mut u8) -> *mut u8 {
    if memory.is_null() {
        let note = b"{\"note\":\"out of memory\"}\n";
        // SAFETY: write() takes any descriptor, and the text is there.
        unsafe { libc::write(REPLIES.load(Ordering::Relaxed), note.as_ptr().cast(), note.len()) };
    }
    memory
}

#[global_allocator]
static MEMORY: Noting = Noting;

// SPDX-License-Identifier: MIT
// The first ray from Rust: rustc -L <folder of libscarp_c.so> hello.rs
use std::ffi::{c_char, c_void, CStr};
use std::ptr::{null, null_mut};

#[repr(C)]
struct Heights {
    struct_size: usize, samples: *const c_void, row_stride: i64,
    cols: i32, rows: i32, sample_type: i32, surface: i32, wrap: i32, solid: i32,
    cell_x: f64, cell_y: f64, scale: f64, offset: f64, exaggeration: f64, nodata: f64,
    has_nodata: i32, reserved: i32, release: Option<extern "C" fn(*const c_void, *mut c_void)>, user_data: *mut c_void,
}
#[repr(C)]
struct Ray { origin: [f64; 3], direction: [f64; 3], t_min: f64, t_max: f64 }
#[repr(C)]
#[derive(Default)]
struct Hit {
    status: u8, wall: u8, face: u8, reserved: u8, object: u32, t: f64, col: i32, row: i32,
    u: f64, v: f64, height: f64, voxel: [i32; 3], part: u32,
}
#[link(name = "scarp_c")]
extern "C" {
    fn scarp_heights_view(heights: *const Heights, scene: *mut *mut c_void) -> i32;
    fn scarp_cast(scene: *const c_void, ray: *const Ray, from: *const Hit, hit: *mut Hit) -> i32;
    fn scarp_scene_release(scene: *mut c_void);
    fn scarp_last_error() -> *const c_char;
}

fn main() {
    let samples: Vec<f32> = (0..101 * 101).map(|i| 40.0 - ((i % 101 - 50) as f32).hypot((i / 101 - 50) as f32)).collect();
    let heights = Heights {
        struct_size: std::mem::size_of::<Heights>(), samples: samples.as_ptr().cast(), row_stride: 0,
        cols: 101, rows: 101, sample_type: 0, surface: 0, wrap: 0, solid: 0,
        cell_x: 10.0, cell_y: 10.0, scale: 0.0, offset: 0.0, exaggeration: 0.0, nodata: 0.0,
        has_nodata: 0, reserved: 0, release: None, user_data: null_mut(),
    };
    let ray = Ray { origin: [0.0, 500.0, 20.0], direction: [1.0, 0.0, 0.0], t_min: 0.0, t_max: f64::INFINITY };
    let (mut scene, mut hit) = (null_mut(), Hit::default());
    unsafe {
        if scarp_heights_view(&heights, &mut scene) != 0 || scarp_cast(scene, &ray, null(), &mut hit) != 0 {
            panic!("{}", CStr::from_ptr(scarp_last_error()).to_string_lossy());
        }
        scarp_scene_release(scene);
    }
    if hit.status == 1 { println!("hit after {:.2} m in cell ({}, {})", hit.t, hit.col, hit.row); }
}

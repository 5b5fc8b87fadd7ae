# SPDX-License-Identifier: MIT
# The first ray from Python, without the package pyscarp: python3 hello.py libscarp_c.so
import ctypes as c, math, struct, sys

scarp = c.CDLL(sys.argv[1])
scarp.scarp_last_error.restype = c.c_char_p
HEIGHTS = "NPq6i6diiPP"  # scarp_heights; scarp_ray is 8 doubles, scarp_hit "BBBBIdiidddiiiI"
samples = (c.c_float * (101 * 101))(*(40 - math.hypot(i % 101 - 50, i // 101 - 50) for i in range(101 * 101)))
heights = struct.pack(HEIGHTS, struct.calcsize(HEIGHTS), c.addressof(samples), 0, 101, 101, 0, 0, 0, 0,
                      10, 10, 0, 0, 0, 0, 0, 0, 0, 0)
scene, ray, hit = c.c_void_p(), (c.c_double * 8)(0, 500, 20, 1, 0, 0, 0, math.inf), c.create_string_buffer(64)
if scarp.scarp_heights_view(heights, c.byref(scene)) or scarp.scarp_cast(scene, ray, None, hit):
    sys.exit(scarp.scarp_last_error().decode())
status, _, _, _, _, t, col, row = struct.unpack_from("BBBBIdii", hit)
if status == 1:
    print(f"hit after {t:.2f} m in cell ({col}, {row})")
scarp.scarp_scene_release(scene)

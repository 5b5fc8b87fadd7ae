// SPDX-License-Identifier: MIT
// The first ray from C#: mcs Hello.cs && mono Hello.exe, with libscarp_c.so in LD_LIBRARY_PATH.
using System;
using System.Runtime.InteropServices;

[StructLayout(LayoutKind.Sequential)] struct Heights {
  public UIntPtr structSize; public IntPtr samples; public long rowStride;
  public int cols, rows, type, surface, wrap, solid;
  public double cellX, cellY, scale, offset, exaggeration, nodata;
  public int hasNodata, reserved; public IntPtr release, userData;
}
[StructLayout(LayoutKind.Sequential)] struct Ray { public double x, y, z, dx, dy, dz, tMin, tMax; }
[StructLayout(LayoutKind.Sequential)] struct Hit {
  public byte status, wall, face, reserved; public uint obj; public double t; public int col, row;
  public double u, v, height; public int voxelX, voxelY, voxelZ; public uint part;
}
static class Hello {
  [DllImport("scarp_c")] static extern int scarp_heights_view(ref Heights heights, out IntPtr scene);
  [DllImport("scarp_c")] static extern int scarp_cast(IntPtr scene, ref Ray ray, IntPtr from, out Hit hit);
  [DllImport("scarp_c")] static extern void scarp_scene_release(IntPtr scene);
  [DllImport("scarp_c")] static extern IntPtr scarp_last_error();
  static int Main() {
    var samples = new float[101 * 101];
    for (int i = 0; i < samples.Length; ++i) samples[i] = (float)(40 - Math.Sqrt(Math.Pow(i % 101 - 50, 2) + Math.Pow(i / 101 - 50, 2)));
    var pinned = GCHandle.Alloc(samples, GCHandleType.Pinned);  // the scene reads this memory
    var heights = new Heights { structSize = (UIntPtr)Marshal.SizeOf(typeof(Heights)), samples = pinned.AddrOfPinnedObject(), cols = 101, rows = 101, cellX = 10, cellY = 10 };
    var ray = new Ray { y = 500, z = 20, dx = 1, tMax = double.PositiveInfinity };
    IntPtr scene; Hit hit = new Hit();
    if (scarp_heights_view(ref heights, out scene) != 0 || scarp_cast(scene, ref ray, IntPtr.Zero, out hit) != 0) { Console.WriteLine(Marshal.PtrToStringAnsi(scarp_last_error())); return 1; }
    if (hit.status == 1) Console.WriteLine(FormattableString.Invariant($"hit after {hit.t:F2} m in cell ({hit.col}, {hit.row})"));
    scarp_scene_release(scene);
    pinned.Free();
    return 0;
  }
}

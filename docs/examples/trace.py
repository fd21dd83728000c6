# python3 trace.py [SCENE]: how deep a scene is, in letters, by 32 x 16 rays along z.
import ctypes, sys
import numpy as np

library = ctypes.CDLL("libtetrace.so.0.1")
library.tetrace_last_error.restype = ctypes.c_char_p
def call(name, *arguments):
    if getattr(library, "tetrace_" + name)(*arguments) != 0: sys.exit(library.tetrace_last_error().decode())

scene, tracer = ctypes.c_void_p(), ctypes.c_void_p()
info = np.zeros((), [("triangles", "u8"), ("tets", "u8"), ("low", "f8", 3), ("high", "f8", 3)])
call("scene_load", (sys.argv + ["cubes"])[1].encode(), ctypes.byref(scene))
call("scene_get_info", scene, ctypes.c_void_p(info.ctypes.data))
call("open", scene, b"openmp", 0, b"half32", ctypes.byref(tracer))

(x0, y0, z0), (x1, y1, z1) = info["low"], info["high"]
rays = np.zeros((16, 32, 8), np.float32)  # origin, t_min, direction, t_max
rays[..., 0] = np.linspace(x0, x1, 34)[1:-1]
rays[..., 1] = np.linspace(y1, y0, 18)[1:-1, None]
rays[..., 2:] = z1 + 1, 0, 0, 0, -1, np.inf
hits = np.zeros((16, 32), [("triangle", "u4"), ("t", "f4"), ("u", "f4"), ("v", "f4")])
call("trace", tracer, ctypes.c_void_p(rays.ctypes.data), ctypes.c_size_t(hits.size), 0, ctypes.c_void_p(hits.ctypes.data))
depth = np.where(hits["triangle"] == 0xFFFFFFFF, 9, 9 * (hits["t"] - 1) / (z1 - z0)).astype(int)
for row in depth: print("".join("@%#*+=-:. "[d] for d in row).rstrip())

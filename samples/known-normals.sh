#!/usr/bin/env bash
# known-normals.sh PROGRAM [FOLDER] - makes the normal map that known-normals.wrinkle shows: known-normals-map.png, the normals
# of four by four caps of spheres on a plane, each worked out from the sphere, none from heights. Green is up.
set -euo pipefail
: "${1:?usage: known-normals.sh PROGRAM [FOLDER]}"
folder=${2:-.}
# A cap of radius 24 texels, its centre 15 below the plane: so it is 18.7 wide from the middle and 51 degrees steep there.
awk 'BEGIN {
    size = 192; apart = 48; radius = 24; below = 15
    printf "P3\n%d %d\n255\n", size, size
    for (j = 0; j < size; j++)
        for (i = 0; i < size; i++) {
            x = i % apart + 0.5 - apart / 2; y = -(j % apart + 0.5 - apart / 2); z = radius * radius - x * x - y * y
            if (z <= below * below) print 128, 128, 255
            else print int(127.5 * (x / radius + 1) + 0.5), int(127.5 * (y / radius + 1) + 0.5), int(127.5 * (sqrt(z) / radius + 1) + 0.5)
        }
}' | convert ppm:- -strip -depth 8 -define png:compression-level=9 "$folder/known-normals-map.png"

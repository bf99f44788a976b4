/* cancel_lines.h - lines of every long command, and a session with data for them. Include after test.h, in only one
   file of a test. */
#pragma once
#include "base/hash.h"
#include "base/pool.h"
#include "session_help.h"

#include <dirent.h>

/* ---- the files of a folder ---- */

static inline uint64_t look_at_folder(void)
{
    uint64_t sum = 0;
    DIR *dir = opendir(".");
    for (struct dirent *e; (e = readdir(dir));) {
        WrHash name = wr_hash_bytes(e->d_name, strlen(e->d_name), (WrHash){ 0, 0 });
        sum += name.low;
    }
    closedir(dir);
    return sum;
}

/* ---- a session with data ---- */

static const char *const shape_of[] = {
    "grid cells=16x16 width=9",
    "pattern bricks",
    "layer add \"second\"",
    "noise perlin",
    "layer set 2 blend=mix opacity=0.5",
    "layer add \"third\"",
    "ramp cone from=0.5,0.5 to=0.5,1",
    "layer mask 3 from=white",
    "select ellipse centre=0.5,0.5 radii=0.45,0.4",
    "select feather by=20",
};

static inline WrSession *busy_session(WrPool *pool, int side)
{
    WrSessionOptions options = {
        .pool = pool, .outputs = true, .journal = true, .composites = true
    };
    WrSession *s = wr_session_new(&options);
    char line[64];
    snprintf(line, sizeof line, "table %dx%d", side, side);
    must_run(s, line);
    for (size_t i = 0; i < sizeof shape_of / sizeof *shape_of; i++) must_run(s, shape_of[i]);
    return s;
}

/* Large work. Files to be read are written before. */
static const char *const lines[] = {
    "grid cells=512x512 width=2",
    "image big.exr fit=table", /* the file is a normal map */
    "image big.exr fit=table labels=ignore",
    "dab 0.5,0.5 radius=400",
    "stroke radius=200 strength=0.1 points=0.1,0.1;0.9,0.9;0.1,0.9;0.9,0.1;0.5,0.2;0.2,0.8",
    "shape rectangle a=0.1,0.1 b=0.9,0.9 paint=fill",
    "shape ellipse middle=0.5,0.5 radii=0.4,0.3 radius=60 paint=outline",
    "shape polygon points=0.1,0.1;0.9,0.2;0.5,0.9 paint=fill",
    "shape path points=0.1,0.1;0.3,0.9;0.7,0.9;0.9,0.1 paint=fill",
    "flood 0.5,0.5 tolerance=100",
    "ramp linear from=0,0 to=1,0",
    "ramp radial from=0.5,0.5 to=0.5,1 blend=add",
    "ramp cone from=0.5,0.5 to=0.5,1 blend=max",
    "layer merge 3",
    "layer merge 3,1,2",
    "layer add from=\"pattern planks rows=40\"",
    "layer add from=\"link second turn=31 factor=0.5\"",
    "link second turn=31 scale=0.7,-1.2 factor=2",
    "layer flatten",
    "layer clear 1",
    "layer paste big.exr at=0.5,0.5",
    "layer mask 2 from=selection",
    "layer mask 3 from=inverse",
    "layer mask 2 from=height low=0.2",
    "layer mask 2 from=slope low=20",
    "layer mask 2 live=\"wear; occlusion op=max; direction; mask of=1 invert=on\"",
    "select mask 3 mode=add",
    "transform move=17,9",
    "transform turn=31 scale=0.7,-1.2 layers=all",
    "transform move=17,9 leave=on of=1,2",
    "copy copied.exr",
    "copy copied2.exr of=composite",
    "select invert",
    "select rect from=0.1,0.1 to=0.9,0.9 mode=add",
    "select ellipse centre=0.3,0.3 radii=0.2,0.2 mode=add",
    "select lasso points=0.1,0.1;0.9,0.2;0.5,0.9;0.2,0.3 mode=add",
    "select height low=0 high=0.5",
    "select slope low=0 high=30",
    "select flood 0.5,0.5 tolerance=100",
    "select grow by=30",
    "select shrink by=30",
    "select feather by=40",
    "adjust offset du=100 dv=50 layers=all",
    "adjust flip-u layers=all",
    "adjust flip-v layers=all",
    "adjust rotate angle=90",
    "adjust crop x=0 y=0 width=250 height=250",
    "adjust resize width=700 height=700",
    "adjust seamless layers=all",
    "adjust seamless how=patches layers=all",
    "adjust seamless how=mirror layers=all",
    "adjust seamless how=frequency layers=all",
    "adjust match-edges layers=all",
    "adjust even-light sigma=50 layers=all",
    "adjust levels layers=all",
    "adjust invert layers=all",
    "adjust normalise layers=all",
    "adjust add amount=1 layers=all",
    "adjust multiply factor=2 layers=all",
    "adjust clamp low=0.2 high=0.3 layers=all",
    "adjust blur sigma=50 layers=all",
    "adjust sharpen amount=2 sigma=20 layers=all",
    "adjust median radius=8 layers=all",
    "adjust curves points=0,0.2;0.5,0.3;1,1",
    "adjust dilate radius=16 layers=all",
    "adjust erode radius=16 layers=all",
    "adjust slope-limit limit=0.001 layers=all",
    "adjust noise octaves=8 layers=all",
    "adjust warp octaves=8 layers=all",
    "colour big.exr",
    "colouring ramp",
    "normalmap big.exr",
    "roughness big.exr",
    "metalness big.exr",
    "environment big.exr",
    "save new.exr",
    "save new.ora",
    "maps blender .",
    "export height new.png",
    "export height new.tif",
    "export normal+y new.exr",
    "export normal-y new2.png",
    "export lines new3.png",
    "export profile new4.png",
    "export slopes new5.exr",
    "export slope new6.png",
    "export curvature new7.png",
    "export occlusion new11.png",
    "export occlusion new12.exr reach=40",
    "export horizon new13.exr toward=all directions=8",
    "export roughness new16.png box=31",
    "export cavity new17.png",
    "export direction new18.png",
    "export displacement new19.png",
    "export mask new20.png",
    "export wear new21.png",
    "export packed new25.png alpha=cavity",
    "export glb new30.glb",
    "export contact new26.png",
    "export height new27.r16",
    "export height new28.png lay=brick repeat=2x2 mips=on",
    "export lines new29.pdf",
    "export normal-object new22.png",
    "export bump-slopes new24.exr",
    "export stl new8.stl",
    "export ply new9.ply error=0.3",
    "export 3mf new10.3mf error=0.3",
    "export gltf new31.glb error=0.3",
    "export obj new10.obj error=0.3",
    "render new5.png size=700x700",
    "undo 5",
};
#define LINES (int)(sizeof lines / sizeof *lines)

/* Written files stay; everything else is undone. */
static inline void take_back_line(WrSession *session, const char *line)
{
    static const char *const outputs[] = { "save", "export", "render", "maps", "copy" };
    for (int i = 0; i < 5; i++)
        if (strncmp(line, outputs[i], strlen(outputs[i])) == 0) return;
    must_run(session, strncmp(line, "undo", 4) == 0 ? "redo 5" : "undo");
}

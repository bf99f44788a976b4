#include "ui/jobs/file_places.h"

#include "base/file.h"
#include "base/memory.h"
#include "system/path.h"

#include <stddef.h>
#include <string.h>

static bool is_folder(const char *path)
{
    WrFileInfo info;
    return wr_path_info(path, &info) && info.kind == WR_KIND_FOLDER;
}

/* Takes ownership of both strings. */
static void add(WrFilePlace *places, int *count, char *label, char *path, bool named)
{
    bool wanted = *count < WR_FILE_PLACES && is_folder(path);
    for (int i = 0; i < *count && wanted; i++) wanted = strcmp(places[i].path, path) != 0;
    if (wanted) {
        places[(*count)++] = (WrFilePlace){ label, path, named };
        return;
    }
    wr_free(label);
    wr_free(path);
}

int wr_file_places(const char *home, char *const recent[], WrFilePlace places[WR_FILE_PLACES])
{
    static const char *const own[] = { "Documents", "Pictures", "Downloads" };
    int count = 0;
    if (home && home[0]) add(places, &count, wr_strdup("Home"), wr_strdup(home), true);
    for (size_t i = 0; home && home[0] && i < sizeof own / sizeof *own; i++)
        add(places, &count, wr_strdup(own[i]), wr_path_join(home, own[i]), true);
    for (int i = 0; recent[i]; i++) {
        char *folder = wr_path_folder(recent[i]), *slash = strrchr(folder, '/');
        add(places, &count, wr_strdup(slash && slash[1] ? slash + 1 : folder), folder, false);
    }
    return count;
}

void wr_file_places_free(WrFilePlace places[], int count)
{
    for (int i = 0; i < count; i++) {
        wr_free(places[i].label);
        wr_free(places[i].path);
    }
}

static bool is_one_of(const char *ending, const char *const *list)
{
    for (int i = 0; list[i]; i++)
        if (strcmp(ending, list[i]) == 0) return true;
    return false;
}

#define PICTURES                                                                                   \
    "png", "exr", "tif", "tiff", "jpg", "jpeg", "jp2", "bmp", "tga", "hdr", "pfm", "pgm", "ppm",   \
        "webp", "gif", "psd", "dpx", "heic", "avif", "jxl"

const char *const *wr_file_endings(WrFilePurpose purpose)
{
    static const char *const pictures[] = { PICTURES, NULL };
    static const char *const stamps[] = { PICTURES, "gbr", "gih", "pat", NULL };
    static const char *const documents[] = { PICTURES, "wrinkle", "ora", NULL };
    static const char *const models[] = { "gltf", "glb", NULL };
    static const char *const meshes[] = { "obj", "ply", "stl", "gltf", "glb", "off",
                                          "dae", "3ds", "fbx", "lwo",  "x3d", NULL };
    static const char *const patches[] = { "bpt", "txt", NULL };
    static const char *const grounds[] = { PICTURES, "r16", "r32", "raw", "hgt", "fits", NULL };
    if (wr_files_writes(purpose) || purpose == WR_FILE_GENERATE || purpose == WR_FILE_PRESET)
        return NULL;
    if (purpose == WR_FILE_STAMP) return stamps;
    if (purpose == WR_FILE_GLTF) return models;
    if (purpose == WR_FILE_MESH) return meshes;
    if (purpose == WR_FILE_PATCHES) return patches;
    if (purpose == WR_FILE_TERRAIN) return grounds;
    return purpose == WR_FILE_OPEN || purpose == WR_FILE_TABLE ? documents : pictures;
}

bool wr_file_fits(WrFilePurpose purpose, const char *name)
{
    char buffer[16];
    const char *const *endings = wr_file_endings(purpose);
    return !endings || is_one_of(wr_path_ending(name, buffer), endings);
}

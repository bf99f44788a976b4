#include "cli/cli.h"

#include "base/error.h"
#include "base/file.h"
#include "base/text.h"
#include "command/command_line.h"
#include "command/session.h"
#include "document/document.h"
#include "document/document_file.h"
#include "export/check.h"
#include "field/seam_check.h"
#include "image/mesh.h"
#include "scene/objects.h"
#include "scene/scene.h"
#include "surface/mesh_faults.h"
#include "surface/projection.h"
#include "surface/triangles.h"
#include "surface/uv_tiles.h"

#include <math.h>
#include <string.h>

/* ---- meshes of a document ---- */

/* UDIM tiles of a mesh that has several, or that shows the table on one. */
static void add_tiles(const WrScene *object, bool json, WrText *text)
{
    const int udim = object->projection.udim;
    if (object->projection.kind != WR_PROJECTION_UV) return;
    WrUvTiles tiles = wr_uv_tiles(wr_scene_mesh_source(object));
    const bool shown = udim || tiles.count > 1;
    if (shown && json) {
        const char *separator = "";
        wr_text_add(text, ",\"tiles\":{");
        for (int i = 0; i < WR_UDIM_COUNT; i++) {
            if (tiles.triangles[i] == 0) continue;
            wr_text_addf(text, "%s\"%d\":%d", separator, WR_UDIM_FIRST + i,
                         (int)tiles.triangles[i]);
            separator = ",";
        }
        wr_text_addf(text, "},\"crossing\":%d,\"outside\":%d,\"tile\":", (int)tiles.crossing,
                     (int)tiles.outside);
        if (udim) wr_text_addf(text, "%d", udim);
        else wr_text_add(text, "null");
    } else if (shown) {
        wr_text_addf(text, "  tiles    %d of UDIM, with triangles: ", tiles.count);
        wr_uv_tiles_print(&tiles, text);
        if (tiles.crossing)
            wr_text_addf(text, "; triangles across their borders: %d", (int)tiles.crossing);
        if (tiles.outside) wr_text_addf(text, "; triangles outside UDIM: %d", (int)tiles.outside);
        if (udim) wr_text_addf(text, "; tile %d shows the table\n", udim);
        else wr_text_add(text, "; all tiles show the table\n");
    }
    wr_uv_tiles_fini(&tiles);
}

static void add_faults_json(const WrMeshFaults *faults, WrText *text)
{
    for (int i = 0; i < WR_MESH_FAULTS; i++) {
        const double at[3] = { faults->at[i].x, faults->at[i].y, faults->at[i].z };
        wr_text_addf(text, ",\"%s\":{\"count\":%d,\"at\":", wr_mesh_fault_rows[i].name,
                     (int)faults->count[i]);
        for (int k = 0; k < 3 && faults->placed[i]; k++) {
            wr_text_add(text, k ? "," : "[");
            wr_text_add_json_number(text, at[k]);
        }
        wr_text_add(text, faults->placed[i] ? "]}" : "null}");
    }
}

/* Two lines, or a JSON object, for each object with a mesh: edges at which the table does not run on, and faults of the
   mesh. Every model with an atlas has such edges, and many have open ones, so they are no problem of the file; faults that
   make its inside ambiguous are: bits of WrMeshFault, added to problems. */
static bool add_mesh(const WrScene *object, int number, bool json, WrText *text, unsigned *problems,
                     WrError *err)
{
    WrTextureSeams seams;
    WrMeshFaults faults;
    const WrTriangles *file = wr_scene_mesh_source(object);
    if (!wr_triangles_seams(object->triangles, &seams, err) ||
        !wr_mesh_faults_find(file, object->projection.origin, &faults, err))
        return false;
    for (int i = 0; i < WR_MESH_FAULTS; i++)
        if (wr_mesh_fault_rows[i].ambiguous && faults.count[i] > 0) *problems |= 1u << i;
    const double *origin = object->projection.origin;
    const double at[3] = { seams.at.x + origin[0], seams.at.y + origin[1], seams.at.z + origin[2] };
    if (json) {
        wr_text_addf(text,
                     "%s{\"object\":%d,\"seams\":%d,\"longest\":", text->length > 0 ? "," : "",
                     number, (int)seams.edges);
        wr_text_add_json_number(text, seams.length);
        for (int k = 0; k < 3; k++) {
            wr_text_add(text, k ? "," : ",\"at\":[");
            wr_text_add_json_number(text, at[k]);
        }
        wr_text_add(text, "]");
        add_tiles(object, true, text);
        add_faults_json(&faults, text);
        wr_text_add(text, "}");
        return true;
    }
    wr_text_addf(text, "  mesh %-3d the table runs on across ", number);
    if (seams.edges == 0) wr_text_add(text, "all edges\n");
    else
        wr_text_addf(text,
                     "all edges but %d; the longest run of them is %.4g long, at %.7g,%.7g,%.7g\n",
                     (int)seams.edges, seams.length, at[0], at[1], at[2]);
    add_tiles(object, false, text);
    wr_text_addf(text, "  mesh %-3d %d triangle%s, %s", number, (int)file->triangle_count,
                 file->triangle_count == 1 ? "" : "s", wr_mesh_faults_body(&faults, file));
    wr_mesh_faults_text(&faults, text);
    wr_text_add(text, "\n");
    return true;
}

/* A script and the file of a mesh have no picture, but meshes. */
typedef enum CheckSource { CHECK_PICTURE, CHECK_SCRIPT, CHECK_MESH } CheckSource;

static CheckSource source_of(const char *path)
{
    char ending[16];
    wr_path_ending(path, ending);
    if (wr_mesh_named(path)) return CHECK_MESH;
    return strcmp(ending, "wrinkle") == 0 ? CHECK_SCRIPT : CHECK_PICTURE;
}

static bool read_mesh(WrSession *session, const char *path, WrError *err)
{
    WrText line = { 0 };
    wr_text_add(&line, "surface mesh file=");
    wr_text_add_word(&line, path);
    const bool good = wr_session_run(session, wr_text_get(&line), err);
    wr_text_fini(&line);
    return good;
}

static bool add_meshes(const WrCli *cli, const char *path, WrText *text, unsigned *problems,
                       WrError *err)
{
    const CheckSource source = source_of(path);
    if (source == CHECK_PICTURE && !wr_document_recognise(path)) return true;
    WrSession *session = wr_cli_session(cli, false, err);
    bool good = session && (source == CHECK_MESH ? read_mesh(session, path, err)
                                                 : wr_session_open(session, path, err));
    const WrScene *scene = good ? wr_session_document(session)->scene : NULL;
    for (int i = 0; good && i < wr_scene_object_count(scene); i++) {
        const WrScene *object = wr_scene_object(scene, i);
        if (object->triangles && object->shape.kind == WR_SURFACE_mesh)
            good = add_mesh(object, i + 1, cli->json, text, problems, err);
    }
    wr_session_free(session);
    if (good && source == CHECK_SCRIPT && text->length == 0)
        return wr_fail(
            err, "%s: is a script without a mesh: check a picture or a document that it writes",
            path);
    return good;
}

/* ---- text output ---- */

static const char *const kind_names[WR_CHECK_KIND_COUNT] = {
    [WR_CHECK_HEIGHT] = "heights",
    [WR_CHECK_NORMAL] = "normals",
    [WR_CHECK_SLOPES] = "slopes",
    [WR_CHECK_COLOUR] = "colours",
};

static void add_edge(WrText *text, const char *name, const WrCheckEdge *edge)
{
    wr_text_addf(text, "  %-8s ", name);
    if (!edge->judged) {
        wr_text_add(text, "not judged: too few texels, or not the edge of a cell\n");
        return;
    }
    wr_text_addf(text, "%s: ", edge->seam ? "A SEAM" : "seamless");
    wr_seam_text(&edge->test, text);
    if (edge->by_label) wr_text_add(text, "; but its label says that the pattern is torn");
    if (edge->repeats) wr_text_add(text, "; the last line is the first one again: leave it out");
    wr_text_add(text, "\n");
}

static void add_numbers(WrText *text, const WrCheck *check)
{
    const WrCheckNumbers *n = &check->numbers;
    const bool many = n->distinct >= WR_CHECK_DISTINCT && check->depth == 32;
    wr_text_addf(text, "  numbers  %d%s different, %.6g to %.6g", n->distinct,
                 many ? " or more" : "", n->low, n->high);
    if (n->half) wr_text_add(text, ", half precision");
    else if (n->judged && n->bits < check->depth)
        wr_text_addf(text, ", %d bit%s would hold them", n->bits, n->bits == 1 ? "" : "s");
    wr_text_add(text, "\n");
    if (check->kind == WR_CHECK_HEIGHT && n->distinct > 1)
        wr_text_addf(text, "  ends     %.3g %% are the lowest, %.3g %% the highest\n",
                     100 * n->at_low, 100 * n->at_high);
}

static void add_normals(WrText *text, const WrCheck *check)
{
    const WrCheckNormals *n = &check->normals;
    if (check->kind != WR_CHECK_NORMAL && check->kind != WR_CHECK_SLOPES) return;
    wr_text_addf(text, "  green    %s\n",
                 !n->green_known ? "up or down cannot be told"
                 : n->green_down ? "down (-Y)"
                                 : "up (+Y)");
    if (check->depth == 32 && check->kind == WR_CHECK_NORMAL)
        wr_text_addf(text, "  coding   %s\n",
                     n->own ? "signed: the vectors' own numbers" : "unit: 0..1 stands for -1..1");
    if (n->lengths) wr_text_addf(text, "  lengths  1, off by up to %.3g\n", n->off);
    if (n->curl_known)
        wr_text_addf(text, "  curl     %.3g (0: of a height, 1: of none)\n", n->curl);
}

static const char *problem_text(WrCheckProblem problem)
{
    switch (problem) {
    case WR_CHECK_SEAM_U: return "left and right edge do not meet";
    case WR_CHECK_SEAM_V: return "top and bottom edge do not meet";
    case WR_CHECK_LOST: return "numbers that are not finite";
    case WR_CHECK_STEPS: return "the steps of 8 bits or fewer in a deeper file";
    case WR_CHECK_LENGTH: return "normals whose length is not 1";
    case WR_CHECK_AWAY: return "normals that look away from the surface";
    case WR_CHECK_CURL: return "no height has these slopes";
    case WR_CHECK_CONVERTED: return "its mean is that of data converted as if they were colours";
    case WR_CHECK_LABEL: return "its label makes no sense, or tells another green than it has";
    case WR_CHECK_PROBLEM_COUNT: break;
    }
    return "";
}

/* The last lines of a file. */
static void add_problems(WrText *text, unsigned picture, unsigned mesh)
{
    for (int i = 0; i < WR_CHECK_PROBLEM_COUNT; i++)
        if (picture >> i & 1)
            wr_text_addf(text, "  PROBLEM  %s\n", problem_text((WrCheckProblem)i));
    for (int i = 0; i < WR_MESH_FAULTS; i++)
        if (mesh >> i & 1) wr_text_addf(text, "  PROBLEM  %s\n", wr_mesh_fault_rows[i].label);
    if (!picture && !mesh) wr_text_add(text, "  good\n");
}

static void add_lines(WrText *text, const char *path, const WrCheck *check)
{
    wr_text_addf(text, "%s: %dx%d, %d channel%s of %s, %s", path, check->width, check->height,
                 check->channels, check->channels == 1 ? "" : "s",
                 check->depth == 8    ? "8 bits"
                 : check->depth == 16 ? "16 bits"
                                      : "floats",
                 kind_names[check->kind]);
    wr_text_addf(text, "%s%s\n", check->label ? "; labelled " : "",
                 check->label ? check->label : "");
    add_edge(text, "u", &check->u);
    add_edge(text, "v", &check->v);
    add_numbers(text, check);
    add_normals(text, check);
}

/* ---- JSON output ---- */

static void json_number(WrText *text, const char *name, double x)
{
    wr_text_addf(text, ",\"%s\":", name);
    wr_text_add_json_number(text, x);
}

static void json_string(WrText *text, const char *name, const char *value)
{
    wr_text_addf(text, ",\"%s\":", name);
    if (value) wr_text_add_json_string(text, value);
    else wr_text_add(text, "null");
}

static const char *truth(bool yes)
{
    return yes ? "true" : "false";
}

static void json_edge(WrText *text, const char *name, const WrCheckEdge *edge)
{
    const WrSeamEdge *test = &edge->test;
    const int k = wr_seam_worst(test);
    wr_text_addf(text, ",\"%s\":{\"seamless\":%s", name,
                 edge->judged ? truth(!edge->seam) : "null");
    json_string(text, "order", edge->judged ? wr_certificate_word(test->order) : NULL);
    json_number(text, "break", test->across[k]);
    json_number(text, "inside", test->inside[k]);
    json_number(text, "ratio", test->ratio[k]);
    json_number(text, "rank", test->rank);
    wr_text_addf(text, ",\"told\":%s,\"repeats\":%s}", truth(edge->by_label), truth(edge->repeats));
}

static void json_numbers(WrText *text, const WrCheckNumbers *n)
{
    wr_text_addf(text, ",\"numbers\":{\"distinct\":%d,\"bits\":", n->distinct);
    if (n->judged) wr_text_addf(text, "%d", n->bits);
    else wr_text_add(text, "null");
    wr_text_addf(text, ",\"half\":%s", truth(n->half));
    json_number(text, "low", n->low);
    json_number(text, "high", n->high);
    json_number(text, "at_low", n->at_low);
    json_number(text, "at_high", n->at_high);
    wr_text_add(text, "}");
}

static void json_normals(WrText *text, const WrCheck *check)
{
    const WrCheckNormals *n = &check->normals;
    wr_text_add(text, ",\"normals\":");
    if (check->kind != WR_CHECK_NORMAL && check->kind != WR_CHECK_SLOPES) {
        wr_text_add(text, "null");
        return;
    }
    wr_text_addf(text, "{\"green\":%s",
                 !n->green_known ? "null"
                 : n->green_down ? "\"down\""
                                 : "\"up\"");
    wr_text_addf(text, ",\"coding\":\"%s\"", n->own ? "signed" : "unit");
    json_number(text, "off", n->lengths ? n->off : NAN);
    json_number(text, "curl", n->curl_known ? n->curl : NAN);
    wr_text_addf(text, ",\"away\":%lld}", (long long)n->away);
}

/* The last members of a file's object. */
static void json_problems(WrText *text, unsigned picture, unsigned mesh)
{
    const char *separator = "";
    wr_text_add(text, ",\"problems\":[");
    for (int i = 0; i < WR_CHECK_PROBLEM_COUNT + WR_MESH_FAULTS; i++) {
        const int fault = i - WR_CHECK_PROBLEM_COUNT;
        if (!((fault < 0 ? picture >> i : mesh >> fault) & 1)) continue;
        wr_text_addf(text, "%s\"%s\"", separator,
                     fault < 0 ? wr_check_problems[i] : wr_mesh_fault_rows[fault].name);
        separator = ",";
    }
    wr_text_add(text, "]}\n");
}

static void json_picture(WrText *text, const WrCheck *check)
{
    wr_text_addf(text, ",\"width\":%d,\"height\":%d,\"channels\":%d,\"depth\":%d", check->width,
                 check->height, check->channels, check->depth);
    json_string(text, "kind", wr_check_kinds[check->kind]);
    json_string(text, "label", check->label);
    json_edge(text, "u", &check->u);
    json_edge(text, "v", &check->v);
    json_numbers(text, &check->numbers);
    json_normals(text, check);
    wr_text_addf(text, ",\"not_finite\":%lld", (long long)check->replaced);
}

/* check: NULL if the file is no picture. meshes: lines or objects of its meshes, or "". */
static void add_file(WrText *text, const char *path, const WrCheck *check, const char *meshes,
                     unsigned problems, bool json)
{
    const unsigned picture = check ? check->problems : 0;
    if (!json) {
        if (check) add_lines(text, path, check);
        else wr_text_addf(text, "%s:\n", path);
        wr_text_add(text, meshes);
        add_problems(text, picture, problems);
        return;
    }
    wr_text_add(text, "{\"file\":");
    wr_text_add_json_string(text, path);
    if (check) json_picture(text, check);
    if (*meshes) wr_text_addf(text, ",\"meshes\":[%s]", meshes);
    json_problems(text, picture, problems);
}

/* ---- the subcommand ---- */

static bool find_kind(const WrCli *cli, int *kind, WrError *err)
{
    *kind = -1;
    return !cli->kind ||
           wr_cli_find_word("--as", cli->kind, wr_word_of_array, wr_check_kinds, kind, err);
}

static bool find_coding(const WrCli *cli, WrCoding *coding, WrError *err)
{
    int found = WR_CODING_AUTO;
    bool good = !cli->coding || wr_cli_find_word("--coding", cli->coding, wr_word_of_array,
                                                 wr_codings, &found, err);
    *coding = (WrCoding)found;
    return good;
}

/* Check one file; returns 1 if it is faulty or unreadable. */
static int check_one(const WrCli *cli, const char *path, int kind, WrCoding coding)
{
    WrCheck check;
    WrError err = { "" };
    WrText text = { 0 }, meshes = { 0 };
    unsigned problems = 0;
    const bool picture = source_of(path) == CHECK_PICTURE;
    const bool read = (!picture || wr_check_picture(path, kind, coding, &check, &err)) &&
                      add_meshes(cli, path, &meshes, &problems, &err);
    int status = read ? WR_EXIT_DONE : wr_cli_fail(cli, WR_EXIT_FAILED, &err);
    if (!picture) check.problems = 0;
    if (read)
        add_file(&text, path, picture ? &check : NULL, wr_text_get(&meshes), problems, cli->json);
    else if (cli->json && status != WR_EXIT_INTERRUPTED) {
        wr_text_add(&text, "{\"file\":");
        wr_text_add_json_string(&text, path);
        json_string(&text, "error", err.text);
        wr_text_add(&text, "}\n");
    }
    if (status != WR_EXIT_INTERRUPTED &&
        (wr_cli_print(cli, &text) != WR_EXIT_DONE || (read && (check.problems || problems))))
        status = WR_EXIT_FAILED;
    wr_text_fini(&meshes);
    wr_text_fini(&text);
    return status;
}

int wr_cli_check(const WrCli *cli)
{
    WrError err;
    int kind, status = WR_EXIT_DONE;
    WrCoding coding;
    if (cli->word_count == 0) {
        wr_fail(&err, "check: needs a FILE, or several");
        return wr_cli_fail(cli, WR_EXIT_USAGE, &err);
    }
    if (!find_kind(cli, &kind, &err) || !find_coding(cli, &coding, &err))
        return wr_cli_fail(cli, WR_EXIT_FAILED, &err);
    for (int i = 0; i < cli->word_count && status != WR_EXIT_INTERRUPTED; i++) {
        const int one = check_one(cli, cli->words[i], kind, coding);
        if (one != WR_EXIT_DONE) status = one;
    }
    return status;
}

#include "cli/cli.h"

#include "export/map_sets.h"

#include <string.h>

#define BIT(name) (1u << WR_OPTION_##name)

const WrSubcommand wr_subcommands[] = {
    { "paint", "[paint] [FILE] [--live FOLDER [--as KIND]]", "open the window", BIT(LIVE),
      "Opens FILE, or a starter document. A mesh becomes the object's surface, a .myb file\n"
      "the brush.",
      wr_cli_paint },
    { "run", "run SCRIPT [--json]", "run a script, including commands that write files", BIT(JSON),
      "SCRIPT is a text file with one command per line; - is standard input. Paths of files to "
      "read\n"
      "are relative to the script's folder, paths of files to write to the current folder.\n"
      "--json prints a record of each written file, one JSON object per line.",
      wr_cli_run },
    { "render",
      "render [FILE] -o OUT [--size WxH] [--rows A-B] [--frames A-B [--of N] [--fps N]] "
      "[--missing] [--json]",
      "render a picture, or a turntable as pictures or a film",
      BIT(OUT) | BIT(SIZE) | BIT(FULL) | BIT(RENDER) | BIT(FORMAT) | BIT(JSON),
      "exr and tiff files store linear floats and coverage, other formats 8-bit sRGB over the "
      "scene's\n"
      "background. Frame f of a turntable is turned by f times --turn degrees, or by f/N of a full "
      "turn.\n"
      "Films (gif, apng, webp, mp4) are made by the program ffmpeg.\n"
      "Large pictures are rendered and written in bands of rows; with a tolerance they are kept "
      "whole in memory.\n"
      "-o - writes a picture or a film to standard output. --json prints a record of each written "
      "file.",
      wr_cli_render },
    { "export", "export [FILE...] --as KIND [name=value...] -o OUT [-j N] [--json] [--watch]",
      "export the table for other programs",
      BIT(OUT) | BIT(AS) | BIT(FORMAT) | BIT(FILES) | BIT(JSON),
      "`wrinkle help export` lists the kinds and their arguments. `--as SET -o FOLDER` writes all "
      "maps\n"
      "for another program, or none: " WR_MAP_SET_NAMES ",\n"
      "and your own sets, NAME.set in the folder sets of your settings.\n"
      "For several files, or if OUT is a folder, each output is OUT/NAME.ENDING. A file that fails "
      "does\n"
      "not stop the others; the exit status is then 1. -o - writes one file to standard output, "
      "and the\n"
      "report to standard error.\n"
      "--json prints a record of each written file, one JSON object per line.",
      wr_cli_export },
    { "check", "check FILE... [--as KIND] [--coding CODING] [--json]",
      "check whether pictures tile and meshes are closed", BIT(CHECK) | BIT(JSON) | BIT(ALL_WORDS),
      "Pictures of any program: the step between opposite edges, compared with steps inside; the "
      "depth of the\n"
      "values; for normal maps the direction of green, the vectors' lengths, and whether a height "
      "has such slopes.\n"
      "Meshes, also those in documents and scripts: open, non-manifold and flipped edges, "
      "duplicate faces,\n"
      "and seams of the table.\n"
      "Problems are edges of more than two faces, flipped and duplicate faces, which slicers "
      "refuse or guess at;\n"
      "open edges and faces without area are only counted.\n"
      "The exit status is 1 if a problem is found or a file cannot be read; all files are checked. "
      "--json: one\n"
      "object per line.",
      wr_cli_check },
    { "inspect", "inspect [FILE] [--at U,V]... [--noise COMMAND] [--json]",
      "print every quantity of the formulas at a point",
      BIT(AT) | BIT(NOISE) | BIT(FACE) | BIT(JSON),
      "Without --at: the table's size, the layers and the document's hash. Values are in object "
      "space and\n"
      "double precision; F, Fu, Fv include the bump's height and the replication.",
      wr_cli_inspect },
    { "explain",
      "explain [FILE] [--measure] [--layers] [--map FILE] [--full] [--json] [--size WxH]",
      "print the plan of a picture, or of the layers, with reasons",
      BIT(JSON) | BIT(SIZE) | BIT(FULL) | BIT(EXPLAIN) | BIT(MAP),
      "Renders once and prints the effects that ran and those that were left out. Class I: leaving "
      "it out\n"
      "gives the same bits; B: within a stated bound; P: a choice that changes the picture.\n"
      "--measure takes some seconds: it alternates planned frames with frames that have one effect "
      "switched.\n"
      "Costs: time that an effect takes; saved: time that an effect that was left out would take.",
      wr_cli_explain },
    { "accuracy", "accuracy [FILE] [--size WxH] [--plot FILE]... [--csv FILE] [--json]",
      "measure error and time of each approximation", BIT(JSON) | BIT(ACCURACY) | BIT(MAP),
      "Renders the document with each setting of each dial, one at a time and in the combinations "
      "that\n"
      "matter; measures times interleaved, on one processor unless --threads is given, and errors\n"
      "against a reference in double precision.",
      wr_cli_accuracy },
    { "recover", "recover [N|JOURNAL -o OUT|--in-place|--script] [discard N|JOURNAL]",
      "recover work after a crash", BIT(OUT) | BIT(JSON) | BIT(RECOVER) | BIT(ALL_WORDS),
      "Without arguments: lists the journals. With a number of that list, or a journal's path: "
      "recovers its\n"
      "document and saves it to OUT. A command that had not ended is tried in a separate process "
      "first.\n"
      "The journal is removed when everything was recovered and OUT was read back. If something is "
      "missing, the\n"
      "journal is kept and the exit status is 1; use --beyond, --script or discard.",
      wr_cli_recover },
    { "brushes", "brushes [NAME...] [--sheet FILE] [--json]",
      "list the brush presets and their settings", BIT(SHEET) | BIT(JSON) | BIT(ALL_WORDS),
      "Without names: all presets, by collection and group. With names: the description of each, "
      "its brush, and\n"
      "which of its settings are used, have another meaning here, or are ignored.\n"
      "--sheet paints the same stroke with each and shows them lit, with their names.",
      wr_cli_brushes },
    { "bench",
      "bench [PART...|all|generate|brushes|edits|moments|promises|scale|start|window] "
      "[--quick] [--exact] [--lines] [--size WxH] [--json]",
      "run the benchmark", BIT(SIZE) | BIT(JSON) | BIT(ALL_WORDS) | BIT(OWN),
      "Without arguments: pictures, documents, brushes and the window.\n"
      "generate: generators, compared with gegl and oiiotool if installed;\n"
      "brushes: dabs, compared with libmypaint;\n"
      "edits: dabs among layers, and values dragged in one of 40 live layers;\n"
      "moments: time until a change of a large table is visible;\n"
      "promises: the remaining time that long commands show, compared with the true one;\n"
      "scale: growth of time with table, picture, layers, brush, objects and lights;\n"
      "start: start of the program, opening and saving a document;\n"
      "window: time from a motion of the pen to the screen.\n"
      "A PART: pictures that differ in one setting, compared with the machine's peak speeds: "
      "surfaces, schemes,\n"
      "normals, aliasing, effects, isa, plan, still, first, output, simd; all: all parts, half a "
      "minute.\n"
      "--quick: fewer and smaller; --exact: exact arithmetic instead of fast; --lines: one line "
      "per\n"
      "measurement, for programs; --json: everything, or what is named.",
      wr_cli_bench },
    { "help", "help [VERB...] [--json|--markdown|--completion SHELL]",
      "describe the commands of scripts and --do", BIT(JSON) | BIT(MARKDOWN) | BIT(ALL_WORDS),
      "--markdown prints tables of the guide: the arguments of a VERB; `verbs`: all verbs; "
      "`subcommands`:\n"
      "subcommands and options; `effects`: the effects that a plan can leave out, and when.",
      wr_cli_help_command },
    { .name = NULL }
};

const WrSubcommand *wr_subcommand_find(const char *name)
{
    for (const WrSubcommand *c = wr_subcommands; c->name; c++)
        if (strcmp(c->name, name) == 0) return c;
    return NULL;
}

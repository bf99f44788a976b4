#include "cli/cli.h"

#include "export/map_sets.h"

#include <string.h>

#define BIT(name) (1u << WR_OPTION_##name)

const WrSubcommand wr_subcommands[] = {
    { "paint", "[paint] [FILE] [--live FOLDER [--as KIND]]", "the window", BIT(LIVE),
      "Opens FILE for painting, without one a starter document. A mesh becomes the object's "
      "surface,\n"
      "a .myb file the brush.",
      wr_cli_paint },
    { "run", "run SCRIPT [--json]", "run a script's commands, files included", BIT(JSON),
      "SCRIPT is a text file with one command a line; - reads standard input. Files are read "
      "relative\n"
      "to the script's folder and written relative to the current one.\n"
      "--json prints a receipt of each written file, one object a line.",
      wr_cli_run },
    { "render",
      "render [FILE] -o OUT [--size WxH] [--rows A-B] [--frames A-B [--of N] [--fps N]] "
      "[--missing] [--json]",
      "a picture, or a turntable as pictures or as a film",
      BIT(OUT) | BIT(SIZE) | BIT(FULL) | BIT(RENDER) | BIT(FORMAT) | BIT(JSON),
      "exr and tiff files hold linear float red, green, blue and coverage, others 8-bit sRGB over "
      "the\n"
      "scene's background. Frame f of a turntable is turned by f times --turn degrees, or f/N of a "
      "full turn.\n"
      "Films, gif, apng, webp and mp4, are made by the program ffmpeg.\n"
      "Large pictures are drawn and written by bands of rows; under a tolerance they are held "
      "whole.\n"
      "-o - writes a picture or a film to standard output. --json prints a receipt of each written "
      "file.",
      wr_cli_render },
    { "export", "export [FILE...] --as KIND [name=value...] -o OUT [-j N] [--json] [--watch]",
      "the table for other programs", BIT(OUT) | BIT(AS) | BIT(FORMAT) | BIT(FILES) | BIT(JSON),
      "`wrinkle help export` lists the kinds and their arguments. `--as SET -o FOLDER` writes the "
      "maps for another program, "
      "all or none: " WR_MAP_SET_NAMES ", and "
      "those of your own, NAME.set in the folder sets of your settings.\n"
      "Of several files, or where OUT is a folder, each output is OUT/NAME.ENDING. A file that "
      "fails "
      "does not stop\n"
      "the others; the status is then 1. -o - writes the bytes of one file to standard output, "
      "and the report to standard error.\n"
      "--json prints a receipt of each written file, one object a line.",
      wr_cli_export },
    { "check", "check FILE... [--as KIND] [--coding CODING] [--json]",
      "whether pictures are seamless cells and meshes closed bodies, and their content",
      BIT(CHECK) | BIT(JSON) | BIT(ALL_WORDS),
      "Of any picture, whoever made it: do opposite edges meet, beside the breaks inside; how fine "
      "are its "
      "numbers;\n"
      "of normals which way green runs, whether their lengths are 1, and whether a height has such "
      "slopes.\n"
      "Of meshes, also those of documents and scripts: open, crowded and turned edges, doubled "
      "faces, edges of the table.\n"
      "Problems are edges of more than two faces, turned faces and doubled ones, which slicers "
      "refuse or guess at; open edges and faces without area are only counted.\n"
      "The status is 1 where a problem is found or a file cannot be read; all files are looked at. "
      "--json: one\n"
      "object a line.",
      wr_cli_check },
    { "inspect", "inspect [FILE] [--at U,V]... [--noise COMMAND] [--json]",
      "every quantity of the formulas at a point", BIT(AT) | BIT(NOISE) | BIT(FACE) | BIT(JSON),
      "Without --at: the table's size, the layers and the document's hash. In object space, in "
      "double\n"
      "precision; F, Fu, Fv carry the bump's height and the replication.",
      wr_cli_inspect },
    { "explain",
      "explain [FILE] [--measure] [--layers] [--map FILE] [--full] [--json] [--size WxH]",
      "the plan of a picture, or of the layers, with reasons",
      BIT(JSON) | BIT(SIZE) | BIT(FULL) | BIT(EXPLAIN) | BIT(MAP),
      "Renders once and prints the effects that ran and those left out. class I: leaving it out "
      "gives\n"
      "the same bits; B: within a stated bound; P: a choice that changes the picture.\n"
      "--measure needs some seconds: frames as planned and with one effect forced the other way, "
      "by "
      "turns.\n"
      "costs: what the frame takes less without an effect that runs; saved: what it would take "
      "more "
      "with one\n"
      "that was left out.",
      wr_cli_explain },
    { "accuracy", "accuracy [FILE] [--size WxH] [--plot FILE]... [--csv FILE] [--json]",
      "error and time of each approximation", BIT(JSON) | BIT(ACCURACY) | BIT(MAP),
      "Renders the document with each rung of each dial, one at a time and in the combinations "
      "that\n"
      "matter; times them interleaved, on one processor unless --threads says otherwise; measures "
      "each\n"
      "against a reference in double precision.",
      wr_cli_accuracy },
    { "recover", "recover [N|JOURNAL -o OUT|--in-place|--script] [discard N|JOURNAL]",
      "work that a crash left behind", BIT(OUT) | BIT(JSON) | BIT(RECOVER) | BIT(ALL_WORDS),
      "Without words: what there is. With a number of that list, or a journal's path: brings its "
      "document\n"
      "back and saves it to OUT. A command that had not ended is tried in a process of its own "
      "first.\n"
      "The journal is removed when everything came back and OUT was read back; where something is "
      "missing it\n"
      "is kept, the status is 1, and --beyond, --script and discard are what is left to do.",
      wr_cli_recover },
    { "brushes", "brushes [NAME...] [--sheet FILE] [--json]",
      "the brush presets and their settings", BIT(SHEET) | BIT(JSON) | BIT(ALL_WORDS),
      "Without names: all presets that are found, by collection and group. With names: what each "
      "says\n"
      "of itself, its brush, and which of its settings are used, mean something else, or are left "
      "out.\n"
      "--sheet paints the same stroke with each and shows them lit, with their names.",
      wr_cli_brushes },
    { "bench",
      "bench [PART...|all|generate|brushes|edits|moments|promises|scale|start|window] "
      "[--quick] [--exact] [--lines] [--size WxH] [--json]",
      "the program's own benchmark", BIT(SIZE) | BIT(JSON) | BIT(ALL_WORDS) | BIT(OWN),
      "Pictures, documents, brushes and the window; with generate alone the generators, beside "
      "gegl\n"
      "and oiiotool where they are installed, with brushes alone dabs beside libmypaint,\n"
      "with edits alone dabs among layers, and values dragged in one of 40 live layers,\n"
      "with moments alone how soon large tables are seen after a change,\n"
      "with promises alone the time left that long commands say, beside what is left,\n"
      "with scale alone how the time grows with the table, the picture, layers, brush, objects\n"
      "and lights,\n"
      "with start alone the start, and opening and saving of a document,\n"
      "with window alone how soon a motion of the pen is seen. A PART alone:\n"
      "pictures that differ in one thing, beside the machine's peaks of the same run: surfaces, "
      "schemes,\n"
      "normals, aliasing, effects, isa, plan, still, first, output, simd;\n"
      "all: each of them, half a minute.\n"
      "--quick: fewer and smaller; --exact: exact arithmetic in place of fast; --lines: one line "
      "a\n"
      "measurement, for programs; --json: all parts and these lines, or what is named.",
      wr_cli_bench },
    { "help", "help [VERB...] [--json|--markdown|--completion SHELL]",
      "the commands of scripts and --do", BIT(JSON) | BIT(MARKDOWN) | BIT(ALL_WORDS),
      "--markdown prints tables of the guide: of a VERB its arguments; `verbs` all verbs, "
      "`subcommands`\nthese with their options, `effects` the effects that a plan leaves out, and "
      "when.",
      wr_cli_help_command },
    { .name = NULL }
};

const WrSubcommand *wr_subcommand_find(const char *name)
{
    for (const WrSubcommand *c = wr_subcommands; c->name; c++)
        if (strcmp(c->name, name) == 0) return c;
    return NULL;
}

/* A lesson's hard cases three ways: by GLSL on OSMesa and by GLM in float, each against GLM in double.
 * Prints TAP, a line a case, and writes the rows of hard_cases.csv. Linked with the two tables that
 * cases_glm.cpp makes of one lesson. */
#define _GNU_SOURCE /* open_memstream */
#include "cases_table.h"
#include "context.h"
#include "draw.h"
#include "fail.h"

#include <ctype.h>
#include <glob.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Cases in one shader: compiling them is most of the time, and grows faster than their number. */
enum { SHADER_CASES = 16 };

static const char *lesson;                       /* "14-parallax" */
static char *folder, *common;                    /* paths to lessons/14-parallax and to common */
static const Case *in_float, *in_double, **list; /* list: the lines of in_double that are cases */
static int line_count, case_count;
static double (*glsl)[4]; /* GLSL's values, four a case */
static FILE *csv;

/* ---- Finding files ---- */

/* The tree that this program was built in: the nearest folder above it that holds the lesson. */
static void find_folders(const char *inside) {
    char root[4096];
    ssize_t length = readlink("/proc/self/exe", root, sizeof root - 1);
    if (length < 0) fail("/proc/self/exe cannot be read");
    root[length] = '\0';
    for (;;) {
        char *slash = strrchr(root, '/');
        if (!slash) fail("no %s above this program", inside);
        *slash = '\0';
        folder = text("%s/%s", root, inside);
        if (access(folder, R_OK) == 0) break;
        free(folder);
    }
    common = text("%s/common", root);
    lesson = strrchr(inside, '/') + 1;
}

static const char *file_name(const char *path) { return strrchr(path, '/') + 1; }

/* A folder's technique files, in alphabetical order; globfree frees them. */
static glob_t technique_files(const char *inside) {
    glob_t files;
    char *pattern = text("%s/*.glsl", inside);
    if (glob(pattern, 0, NULL, &files) != 0) fail("no %s", pattern);
    free(pattern);
    return files;
}

/* ---- GLSL ---- */

/* The numbers of the expressions. They reach the shader in a texture, for what is written in a shader its
 * compiler may evaluate, and then the case would test the compiler instead of the code that it makes. */
typedef struct {
    float *values;
    int count;
} Numbers;

/* Writes an expression with case_number(i) instead of each float literal; integers stay. */
static void write_expression(FILE *out, const char *from, Numbers *numbers) {
    while (*from) {
        char *end = (char *)from;
        bool digit = isdigit((unsigned char)from[0]);
        if (digit || (from[0] == '.' && isdigit((unsigned char)from[1]))) {
            float value = strtof(from, &end);
            size_t length = (size_t)(end - from);
            bool hexadecimal = memchr(from, 'x', length) || memchr(from, 'X', length);
            if (!hexadecimal && strcspn(from, ".eE") < length) {
                numbers->values[numbers->count] = value;
                fprintf(out, "case_number(%d)", numbers->count++);
                from = end + (*end == 'f' || *end == 'F');
            }
        }
        /* an integer with its suffix, a name (which may hold digits), or a single sign */
        for (end = (char *)from; isalnum((unsigned char)*end) || *end == '_';) end++;
        if (end == from && *end && !(*end == '.' && isdigit((unsigned char)end[1]))) end++;
        fwrite(from, 1, (size_t)(end - from), out);
        from = end;
    }
}

/* The shader that evaluates cases first to end - 1, each at the pixel of its number. */
static char *shader_text(int first, int end, Numbers *numbers) {
    char *result;
    size_t size;
    FILE *out = open_memstream(&result, &size);
    fputs("layout(location = 0) out vec4 drawn;\nlayout(location = 1) out vec4 value;\n"
          "uniform sampler2D case_numbers;\n"
          "float case_number(int i) { return texelFetch(case_numbers, ivec2(i, 0), 0).x; }\n"
          "vec4 case_value(float x) { return vec4(x, 0.0, 0.0, 0.0); }\n"
          "vec4 case_value(int x) { return vec4(float(x), 0.0, 0.0, 0.0); }\n"
          "vec4 case_value(bool x) { return vec4(float(x), 0.0, 0.0, 0.0); }\n"
          "vec4 case_value(vec2 v) { return vec4(v, 0.0, 0.0); }\n"
          "vec4 case_value(vec3 v) { return vec4(v, 0.0); }\n"
          "vec4 case_value(vec4 v) { return v; }\n"
          "vec4 case_value(ivec2 v) { return vec4(vec2(v), 0.0, 0.0); }\n"
          "vec4 case_value(ivec3 v) { return vec4(vec3(v), 0.0); }\n"
          "vec4 case_value(ivec4 v) { return vec4(v); }\n",
          out);
    const char *const folders[] = {common, folder}; /* as techniques.h in cases.mk */
    for (int k = 0; k < 2; k++) {
        glob_t files = technique_files(folders[k]);
        for (size_t i = 0; i < files.gl_pathc; i++)
            fprintf(out, "#include \"%s\"\n", file_name(files.gl_pathv[i]));
        globfree(&files);
    }
    for (int i = 0; i < line_count; i++) {
        if (in_double[i].texture)
            fprintf(out, "uniform %s %s;\n", in_double[i].texture->whole ? "usampler2D" : "sampler2D",
                    in_double[i].name);
        else if (!in_double[i].evaluate)
            fprintf(out, "%s\n", in_float[i].text);
    }
    fputs("void main() {\n    drawn = vec4(1.0);\n    switch (int(gl_FragCoord.x)) {\n", out);
    for (int i = first; i < end; i++) {
        fprintf(out, "    case %d: value = case_value(", i - first);
        write_expression(out, list[i]->text, numbers);
        fputs("); break;\n", out);
    }
    fputs("    }\n}\n", out);
    fclose(out);
    return result;
}

/* Fills glsl[first] to glsl[end - 1]. */
static void evaluate(int first, int end, const Texture *textures) {
    size_t length = 1;
    for (int i = first; i < end; i++) length += strlen(list[i]->text);
    Numbers numbers = {.values = allocate(length, sizeof *numbers.values)}; /* no more numbers than letters */
    char *shader = shader_text(first, end, &numbers);
    Program program = {0};
    char *log = program_build_text(&program, folder, common, "everywhere.vert", "cases", shader, GLSL_330);
    if (log) {
        int line = 1; /* the log counts the lines of this text */
        for (char *at = strtok(shader, "\n"); at; at = strtok(NULL, "\n"))
            fprintf(stderr, "%3d %s\n", line++, at);
        fail("%s: the cases are no GLSL:\n%s", lesson, log);
    }
    Image row = {
        .width = numbers.count ? numbers.count : 1, .height = 1, .channels = 1, .pixels = numbers.values};
    Texture numbers_texture = texture_create(&row, 1, TEXTURE_FLOAT, TEXTURE_NEAREST);
    Target target = target_create(end - first, 1, true);
    Picture picture = picture_create(end - first, 1, true);
    target_begin(&target, v3(0, 0, 0));
    program_use(&program);
    program_texture(&program, "case_numbers", &numbers_texture);
    for (int i = 0; i < line_count; i++)
        if (in_double[i].texture) program_texture(&program, in_double[i].name, &textures[i]);
    draw_everywhere();
    target_read(&target, &picture);
    for (int i = first; i < end; i++) {
        if (*image_at(&picture.colour, i - first, 0) != 1.0f) fail("%s: case %d was not drawn", lesson, i);
        for (int k = 0; k < 4; k++) glsl[i][k] = image_at(&picture.lookup, i - first, 0)[k];
    }
    picture_destroy(&picture);
    target_destroy(&target);
    texture_destroy(&numbers_texture);
    program_destroy(&program);
    free(numbers.values);
    free(shader);
}

/* ---- Textures ---- */

/* Makes the texels, by the formula in double, for all three. */
static void make_levels(CaseTexture *texture, CaseTexture *other) {
    int width = texture->width, height = texture->height;
    for (bool last = false; !last;) {
        last = !texture->mipped || (width == 1 && height == 1) || texture->count + 1 == CASE_LEVELS_MAX;
        Image level = image_create(width, height, 4);
        for (int y = 0; y < height; y++)
            for (int x = 0; x < width; x++) texture->texel(x, y, texture->count, image_at(&level, x, y));
        texture->levels[texture->count++] = level;
        width = width > 1 ? width / 2 : 1;
        height = height > 1 ? height / 2 : 1;
    }
    other->count = texture->count;
    memcpy(other->levels, texture->levels, sizeof other->levels);
}

static void evaluate_all(void) {
    Context *context = context_offscreen();
    Texture *textures = allocate((size_t)line_count, sizeof *textures);
    for (int i = 0; i < line_count; i++) {
        CaseTexture *texture = in_double[i].texture;
        if (!texture) continue;
        make_levels(texture, in_float[i].texture);
        int width = texture->width, height = texture->height;
        if (texture->whole)
            textures[i] = texture_packed(width, height, PACKED_U32X4, texture->levels[0].pixels,
                                         4 * sizeof(float) * (size_t)width * (size_t)height);
        else
            textures[i] = texture_create(texture->levels, texture->count, TEXTURE_FLOAT,
                                         texture->mipped ? TEXTURE_TRILINEAR : TEXTURE_LINEAR);
    }
    for (int i = 0; i < case_count; i += SHADER_CASES)
        evaluate(i, i + SHADER_CASES < case_count ? i + SHADER_CASES : case_count, textures);
    for (int i = 0; i < line_count; i++)
        if (textures[i].id) texture_destroy(&textures[i]);
    free(textures);
    context_destroy(context);
}

/* ---- Judging ---- */

/* The function that a case is about: the expression's first name. */
static int function_length(const Case *c) { return (int)strcspn(c->text, "( "); }

/* One component by one evaluation: its row, and its reason if it fails. True if it passes. */
static bool judge(const Case *c, const char *by, int component, int count, double value, double exact) {
    double error = fabs(value - exact), bound = c->bound;
    double rounding = 8 * 0x1p-23 * fmax(fabs(value), fabs(exact)); /* a few ulp: the same branch was taken */
    if (c->flip) bound = fmax(bound, rounding);
    bool good = isfinite(value) && isfinite(exact) && isfinite(bound) && error <= bound;
    const char *pass = !good ? "no" : c->flip && error > rounding ? "flip" : "yes";
    const char *field = count == 1 ? "" : (const char *[]){".x", ".y", ".z", ".w"}[component];
    int length = function_length(c);
    if (csv)
        fprintf(csv, "%s,%.*s@%s,%s%s,%.17g,%.17g,%.17g,%.17g,%s,%s\n", lesson, length, c->text, by, c->name,
                field, value, exact, error, bound, c->unit, pass);
    if (!good)
        printf(
            "# %.*s@%s, case '%s'%s\n#   of        %s\n#   expected  %.9g (in double)\n#   got       %.9g\n"
            "#   error     %.3g, bound %.3g %s\n",
            length, c->text, by, c->name, field, c->text, exact, value, error, bound, c->unit);
    return good;
}

static bool judge_case(int number, const Case *same_in_float) {
    const Case *c = list[number];
    CaseValue exact = c->evaluate(), value = same_in_float->evaluate();
    bool good = true;
    for (int k = 0; k < exact.count; k++)
        good &= judge(c, "glsl", k, exact.count, glsl[number][k], exact.component[k]);
    for (int k = 0; k < exact.count; k++)
        good &= judge(c, "glm", k, exact.count, value.component[k], exact.component[k]);
    printf("%s %d - %.*s: %s\n", good ? "ok" : "not ok", number + 1, function_length(c), c->text, c->name);
    return good;
}

/* Whether each function of the technique files has a case: definitions begin in a line's first column. */
static bool judge_coverage(void) {
    bool good = true;
    glob_t files = technique_files(folder);
    for (size_t i = 0; i < files.gl_pathc; i++) {
        FILE *file = fopen(files.gl_pathv[i], "r");
        if (!file) fail("%s cannot be read", files.gl_pathv[i]);
        char *line = NULL, name[64], parenthesis;
        size_t size = 0;
        while (getline(&line, &size, file) >= 0) {
            if (sscanf(line, "%*[A-Za-z0-9_] %63[A-Za-z0-9_]%c", name, &parenthesis) != 2 ||
                parenthesis != '(')
                continue;
            bool found = false;
            for (int k = 0; k < case_count; k++)
                found |= (size_t)function_length(list[k]) == strlen(name) &&
                         strncmp(list[k]->text, name, strlen(name)) == 0;
            if (!found) printf("# %s: no case for %s\n", file_name(files.gl_pathv[i]), name);
            good &= found;
        }
        free(line);
        fclose(file);
    }
    globfree(&files);
    printf("%s %d - every function has a case\n", good ? "ok" : "not ok", case_count + 1);
    return good;
}

int main(int argc, char **argv) {
    if (argc > 2) fail_usage("one argument at most: the table to write, a .csv");
    find_folders(cases_folder());
    in_double = cases_in_double(&line_count);
    in_float = cases_in_float(&line_count);
    list = allocate((size_t)line_count, sizeof *list);
    for (int i = 0; i < line_count; i++) {
        if (strpbrk(in_double[i].name, ",\"\n"))
            fail("%s: a comma or quote in '%s'", lesson, in_double[i].name);
        if (in_double[i].evaluate) list[case_count++] = &in_double[i];
    }
    if (case_count == 0) fail("%s: cases.h holds no case", lesson);
    glsl = allocate((size_t)case_count, sizeof *glsl);
    evaluate_all();

    if (argc == 2 && !(csv = fopen(argv[1], "w"))) fail("%s: cannot be written", argv[1]);
    if (csv) fputs("lesson,function,case,float_value,double_value,error,bound,unit,pass\n", csv);
    printf("1..%d\n", case_count + 1);
    bool good = true;
    for (int i = 0; i < case_count; i++) good &= judge_case(i, &in_float[list[i] - in_double]);
    good &= judge_coverage();
    if (csv && (ferror(csv) | fclose(csv))) fail("%s: cannot be written", argv[1]);

    for (int i = 0; i < line_count; i++)
        for (int k = 0; in_double[i].texture && k < in_double[i].texture->count; k++)
            image_destroy(&in_double[i].texture->levels[k]);
    free(glsl), free(list), free(folder), free(common);
    return good ? 0 : STATUS_FAILURE;
}

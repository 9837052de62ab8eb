/* Draws a DEM and writes the picture as a PPM: picture DEM TIME OUT.ppm */
#include <relevo/relevo.h>
#include <stdio.h>
#include <stdlib.h>

static int fail(const char* what) {
    fprintf(stderr, "%s: %s\n", what, relevo_error());
    return 1;
}

static int write_ppm(const char* name, const uint8_t* rgba, int32_t columns, int32_t rows) {
    FILE* file = fopen(name, "wb");
    size_t i, count = (size_t)columns * (size_t)rows;
    if (!file) return -1;
    fprintf(file, "P6\n%d %d\n255\n", (int)columns, (int)rows);
    for (i = 0; i < count; ++i)
        fwrite(rgba + 4 * i, 1, 3, file);
    return fclose(file);
}

int main(int argc, char** argv) {
    relevo_dem* dem = NULL;
    relevo_session* session = NULL;
    relevo_open_options options = {.size = sizeof options};
    relevo_picture picture = {.size = sizeof picture};
    char change[200];
    int32_t columns = 640, rows = 400;
    int result = 1;

    if (argc != 4) {
        fprintf(stderr, "usage: picture DEM TIME OUT.ppm\n");
        return 2;
    }
    if (relevo_dem_open((const char* const*)&argv[1], 1, NULL, &dem) != RELEVO_RESULT_OK)
        return fail(argv[1]);
    options.dem = dem;
    if (relevo_open(NULL, &options, &session) != RELEVO_RESULT_OK) return fail("relevo_open");
    relevo_dem_close(dem); /* the session keeps what it needs */

    snprintf(change, sizeof change,
             "{\"time\": {\"at\": \"%.80s\"}, \"picture\": {\"size\": [%d, %d]}}", argv[2],
             (int)columns, (int)rows);
    picture.rgba_count = 4 * (size_t)columns * (size_t)rows;
    picture.rgba = malloc(picture.rgba_count);
    if (relevo_set(session, change) != RELEVO_RESULT_OK)
        fail("relevo_set");
    else if (!picture.rgba || relevo_draw_picture(session, &picture) != RELEVO_RESULT_OK)
        fail("relevo_draw_picture");
    else
        result = write_ppm(argv[3], picture.rgba, columns, rows) != 0;
    free(picture.rgba);
    relevo_close(session);
    return result;
}

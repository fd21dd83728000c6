#include "bench/verbs/commands.h"

int main(int argc, char** argv)
{
    return tetrace::run_program({argv + 1, argv + argc});
}

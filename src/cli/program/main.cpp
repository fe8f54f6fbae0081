#include <iostream>

#include "cli/program/interrupt.hpp"
#include "cli/program/message.hpp"
#include "cli/program/run.hpp"

int main(int argc, char **argv) {
    lensprof::catch_interrupts();
    lensprof::Streams streams{std::cout, std::cerr};
    streams.colour = lensprof::shows_colour();
    int code = lensprof::run({argv + 1, argv + argc}, streams);
    if (!std::cout.flush() && code == 0) {
        std::cerr << "lensprof: cannot write to standard output\n";
        return 1;
    }
    return code;
}

// Prints sizes and offsets of structures, as tests/python/abi_dump.c does; tests/bindings compares the two.
import {TYPES} from '../abi.js';
import {typeMembers} from '../native.js';

for (const [kind, name] of TYPES) {
    if (kind === 'struct') {
        const {size, alignment, members} = typeMembers(name);
        console.log(`struct ${name} ${size} ${alignment}`);
        for (const [field, {offset}] of Object.entries(members)) console.log(`field ${name} ${field} ${offset}`);
    }
}

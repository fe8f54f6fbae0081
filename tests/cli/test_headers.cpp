// Source of the target of the precompiled headers of these tests.

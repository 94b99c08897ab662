// Few shape classes: a table that fits in a uniform buffer, which adapters keep closer than storage.

@group(0) @binding(2) var<uniform> classes: array<Class, 48>;

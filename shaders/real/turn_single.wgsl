// Sine and cosine.
struct Turn { s: real, c: real }

fn turn(angle: real) -> Turn {
    return Turn(sin(angle), cos(angle));
}

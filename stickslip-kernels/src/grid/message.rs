//! Bytes for other ranks.

/// A message with the other rank: whom it is for, or who sent it.
pub type Message = (usize, Vec<u8>);

/// The message to a rank among some, from now on if not before.
pub fn message_to(messages: &mut Vec<Message>, rank: usize) -> &mut Vec<u8> {
    let place = messages.iter().position(|(to, _)| *to == rank).unwrap_or_else(|| {
        messages.push((rank, Vec::new()));
        messages.len() - 1
    });
    &mut messages[place].1
}
